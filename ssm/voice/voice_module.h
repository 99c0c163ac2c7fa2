#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ssm/voice/audio_sink.h"
#include "ssm/voice/emotion.h"
#include "ssm/voice/player.h"
#include "ssm/voice/speakers.h"
#include "ssm/voice/speech_engine.h"
#include "ssm/voice/tape.h"
#include "ssm/voice/text_tags.h"
#include "ssm/voice/utterance.h"
#include "ssm/voice/voice_log.h"
#include "ssm/voice/worker.h"
#include "vm_protocol/core/module.h"
#include "vm_protocol/core/start_time.h"

namespace ssm {

struct Prosody;

inline constexpr std::size_t kMaxTextBytes = 8192;  ///< as the original
inline constexpr std::size_t kMaxWaiting = 64;      ///< requests kept while a text is prepared
/// Texts up to this size are analysed on the spot (some tens of ms), longer ones by the worker.
inline constexpr std::size_t kPromptTextBytes = 256;

/// The voice module (SSM): every slot of the original with its order of reports, and ours.
///
///   IDLE --Text--> PROCESSING --phonemes known--> READY --Speak--> SPEAKING --end, STOP--> IDLE
///                                                        SPEAKING --PAUSE--> PAUSED --RESUME-->
///                                                        SPEAKING
///
/// READY means that playing may begin; the sound is still being made behind it, much faster than
/// it is played. Requests that need the text (Speak, SaveWAV, another Text) and come while it is
/// prepared wait their turn, as they did in the original, which did one thing after another.
/// Thread: the scheduler's.
class VoiceModule final : public vm::Module {
 public:
  struct Parts {
    std::unique_ptr<SpeechEngine> engine;
    std::unique_ptr<AudioSink> sink;
    std::unique_ptr<Worker> worker;
  };
  struct Options {
    std::string module_version{};
    std::vector<SpeakerAlias> aliases = OriginalSpeakers();
    std::string speaker{};  ///< the one at start; empty or unknown = the engine's first
    bool auto_play = false;
    Millis auto_play_delay{0};
    /// Wall time since midnight, for `Speak = HH:MM:SS.mmm`.
    std::function<vm::Time()> wall_clock = vm::WallSinceMidnight;
    /// Sends error texts to a file, or back to the console for "CONSOLE". Empty = not possible.
    std::function<vm::Result<void>(const std::string&)> redirect_errors{};
    /// Sends a copy of what is heard to "unix:PATH", or no longer for "NONE". Empty = not possible.
    std::function<vm::Result<void>(const std::string&)> send_sound{};
    std::function<std::string()> sound_goes_to{};  ///< REQUIRES: not empty where send_sound is not
  };

  /// The scheduler outlives the module.
  VoiceModule(vm::Scheduler& scheduler, Parts parts, Options options);
  ~VoiceModule() override;

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override;
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  enum class State { kIdle, kProcessing, kReady, kSpeaking, kError, kPaused };
  /// A request that waits for the text before it, or for its sound.
  struct Waiting {
    std::function<void()> action;
    vm::Reply reply;
  };
  struct Preparation {
    std::shared_ptr<Utterance> utterance;
    std::vector<SpeechSpan> spans;
    vm::Result<SpeechPlan> plan = vm::Fail(vm::Errc::kStopped, "not planned");
    std::shared_ptr<std::atomic<bool>> cancelled;
    vm::Reply reply;
    bool planned = false;         ///< a next text's plan may be read
    std::deque<Waiting> after{};  ///< what was asked of a next text before it is the present one
    bool spoken = false;          ///< Speak is among it
    std::shared_ptr<const Prosody> prosody{};  ///< from a file; null = the engine's own
    SpeechPlan engine_plan{};                  ///< before the prosody changed it
    std::string wanted{};                      ///< of a next text: what was asked for (WantedNow)
  };

  // voice_manner_slots.cc
  void DeclareManner();
  void DeclareEmotion();

  // voice_slots.cc: what there is to set and to ask.
  void DeclareTextSlots();
  void DeclareSpeakSlots();
  void DeclareFileSlots();
  void DeclareLogSlots();
  void DeclareRefused(const std::string& name, const std::string& why, bool readable);

  // voice_preparing.cc
  static vm::Error TooLong(const std::string& text);
  void SetText(const std::string& text, const vm::Reply& reply);
  void Prepare(const std::string& text, const vm::Reply& reply,
               std::shared_ptr<const Prosody> prosody = nullptr);
  vm::Result<void> Render(const Preparation& preparation);
  vm::Result<TaggedText> ReadText(const std::string& text);
  const VoiceInfo& SpeakerOf(const SpeechSpan& span);
  std::vector<SpeechSpan> Manners(std::vector<SpeechSpan> spans);
  Millis LeadToCut(const Preparation& preparation, SpeechPlan& plan) const;
  void OnPlanned(const std::shared_ptr<Preparation>& preparation);
  void OnRendered(const std::shared_ptr<Utterance>& utterance, const vm::Result<void>& result);
  void ReportPhonemes();
  void MakeReady(const vm::Reply& reply, std::string answer);

  // voice_speaking.cc
  void SetSpeak(const std::string& text, const vm::Reply& reply);
  void Speak(vm::Time at, const std::string& text, const vm::Reply& reply);
  vm::Result<void> StartPlaying(vm::Time at, std::size_t from = 0);
  void Stop();
  void Pause(const vm::Reply& reply);
  void Resume(const vm::Reply& reply);
  void OnEnded(AudioSink::Position end, bool failed);
  AudioSink::Position StopPlayer();
  Millis Spoken() const;
  void Tail(std::size_t frames);

  // voice_module.cc
  void SetState(State state);
  void Fault(std::string_view slot, const vm::Error& error);
  /// Puts off what concerns the next text, or the text being prepared; false: it can be done now.
  bool PutOff(const std::function<void()>& action, const vm::Reply& reply);
  bool MustWait() const { return state_ == State::kProcessing || !waiting_.empty(); }
  void WaitTurn(std::function<void()> action, const vm::Reply& reply);
  void TakeTurns();
  static void Abandon(std::deque<Waiting>& queue, const char* why);
  // voice_files.cc: what goes to files and comes from them.
  void Save(const std::string& path, SoundFormat format, const vm::Reply& reply);
  void SaveAndTell(const std::string& path, SoundFormat format, const vm::Reply& reply);
  void Load(const std::string& path, SoundFormat format, const vm::Reply& reply);
  vm::Result<std::string> SetRecord(const std::string& path);
  void SavePros(const std::string& path, SoundFormat, const vm::Reply& reply);
  void LoadPros(const std::string& path, SoundFormat, const vm::Reply& reply);
  void LoadParsed(const std::string& path, SoundFormat, const vm::Reply& reply);
  void AddToTape(const AudioSink::Position& heard);
  void SetNext(const std::string& text, const vm::Reply& reply);
  void TakeNext();
  void DropNext(const char* why);
  /// A text with the manner it would be spoken in now.
  std::string WantedNow(const std::string& text) const;
  bool TakesNext(const std::string& text, const vm::Reply& reply);

  vm::Scheduler& scheduler_;
  const Options options_;
  vm::SlotMachine slots_;
  const std::unique_ptr<SpeechEngine> engine_;
  const std::unique_ptr<AudioSink> sink_;
  std::unique_ptr<Worker> worker_;  // destroyed first: its thread uses the engine
  Player player_;
  const SpeakerTable speakers_;

  std::set<std::string> noted_;  // what markup asked for and is not done, told already
  VoiceInfo voice_;
  double rate_ = 1;
  double pitch_ = 1;
  double volume_ = 1;
  Feeling feeling_;
  bool auto_play_ = false;
  VoiceLog log_;

  State state_ = State::kIdle;
  std::shared_ptr<Preparation> preparation_;     // while kProcessing
  std::shared_ptr<const Utterance> utterance_;   // what Speak speaks; null = nothing
  std::deque<Waiting> waiting_;                  // for the text being prepared
  std::deque<Waiting> waiting_for_sound_;        // for the utterance's samples
  std::size_t spoken_frames_ = 0;                // of the last utterance spoken
  std::shared_ptr<const SampleBuffer> playing_;  // what the player plays of it: all, or the rest
  std::size_t played_before_ = 0;                // frames of it before `playing_`
  std::shared_ptr<const Utterance> spoken_;      // the one they belong to
  std::unique_ptr<Tape> tape_;
  std::shared_ptr<Preparation> next_;  // made while another is spoken; its samples begun
  /// What the last next text was asked for as, and what came of it.
  std::string next_wanted_;
  std::shared_ptr<const Utterance> next_made_;
  bool exit_requested_ = false;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace ssm
