#pragma once

#include <functional>
#include <memory>
#include <string>

#include "sound/audio_source.h"
#include "vdm/core/mouth_sender.h"
#include "vdm/core/session_clock.h"
#include "vdm/core/voice_manner.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/mouth/sound_clock.h"
#include "vdm/mouth/speaker.h"
#include "vdm/mouth/speaker_learner.h"
#include "vdm/recording/recorded_mouth.h"
#include "vm_protocol/core/module.h"

namespace vdm {

/// The module of voice-driven movement (VDM): hears a source of sound, and tells a face frame by
/// frame what the mouth does, Delay after it was heard.
///
///   OFF --Run = START--> LISTENING --sound of speech--> MOVING --rest--> LISTENING
///
/// To the face: `to @FSM set MouthFrame.start = @T`, then `to @FSM set MouthFrame = MS ...` for
/// each frame. When the source ends, fails or stalls, the mouth closes. Thread: the scheduler's.
class MovementModule final : public vm::Module {
 public:
  struct Options {
    std::string module_version{};
    /// A source by name, as of sound::OpenSource.
    std::function<vm::Result<std::unique_ptr<sound::AudioSource>>(const std::string&)>
        open_source{};
    /// Whether this process's clock is that of the session (a virtual one).
    std::function<bool()> clock_is_shared{};
    /// What the words of a recording (a file's path) have the mouth do; may be none. It takes its
    /// time, so it is asked where nobody waits: on a clock that is shared.
    std::function<RecordedMouth(const std::string&)> read_words{};
    const MouthNet* phones = nullptr;   ///< for PHONES; null where its features cannot be made
    const MouthNet* words = nullptr;    ///< for WORDS, beside `phones`; likewise
    const MouthNet* mel = nullptr;      ///< for Mouth.mode = MEL; outlives the module
    const MouthNet* cepstra = nullptr;  ///< for Mouth.mode = CEPSTRA; likewise
    const HeadNet* head = nullptr;      ///< for Head.auto = ON; likewise, as those below
    const HeadNet* head_by_prosody = nullptr;  ///< for Head.auto = PROSODY
    const Discriminant* emotions = nullptr;    ///< for Emotion.auto = ON
    std::string speakers_folder{};             ///< where learned speakers are kept; empty: nowhere
  };
  /// A live source that gave sound and then none for so long has stalled.
  static constexpr vm::Time kStalled{1'000'000};

  MovementModule(vm::Scheduler& scheduler, Options options);
  ~MovementModule() override;

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override;
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  enum class Mode { kWords, kPhones, kMel, kCepstra, kOff };
  // movement_slots.cc
  void DeclareRun();
  void DeclareInput();
  void DeclareMouth();
  /// A slot in which the module tells something.
  // manner_slots.cc
  void DeclareHead();
  void DeclareEmotion();
  vm::Result<std::string> SetHead(const std::string& word);
  void TellEmotion();
  void TellMood(const std::string& mood, double strength01);
  void TellProsody(vm::Time at);
  void DeclareSpeaker();  // speaker_slots.cc

  vm::Result<std::string> SetInput(const std::string& name);
  vm::Result<void> StartSource();
  void ReadWords();
  void Start();
  void Stop();
  void Hear(std::span<const std::int16_t> samples);
  void OnSourceOver();
  void WatchForStall();
  void FinishWaiting();
  void Show(const MouthTracker::Moment& moment, const std::optional<HeadPose>& head);
  void TellFrame(double ms, const MouthFrame& frame, const std::optional<HeadPose>& head);
  void TellFace(std::string slot, std::string value);
  /// The shortest Delay with which frames are told before their time.
  vm::Time ShortestDelay() const;
  const MouthNet& net() const {
    return mode_ == Mode::kCepstra                           ? *options_.cepstra
           : mode_ == Mode::kPhones || mode_ == Mode::kWords ? *options_.phones
                                                             : *options_.mel;
  }
  Mode BestMode() const {
    return options_.phones == nullptr  ? Mode::kMel
           : options_.words == nullptr ? Mode::kPhones
                                       : Mode::kWords;
  }
  void Learned(const vm::Result<Speaker>& met);
  vm::Result<void> SetMode(const std::string& word);
  /// The sound that comes is another one: nothing of what came before counts; or, of the
  /// `same_speaker`, all but how the speaker usually speaks.
  void Renew(bool same_speaker = false);

  static constexpr double kMoodFrom = 0.6;  // likelihood from which on the face shows it
  static constexpr double kMoodStep = 0.2;  // changes below are not told

  vm::Scheduler& scheduler_;
  const Options options_;
  vm::SlotMachine slots_;
  SessionClock session_;
  MouthSender sender_;

  bool on_ = false;
  bool exit_requested_ = false;
  Mode mode_;
  vm::Time delay_{100'000};
  std::string face_ = "FSM";
  std::unique_ptr<sound::AudioSource> source_;
  std::string source_name_ = "NONE";

  SpeakerStore speakers_;
  Speaker speaker_;
  std::unique_ptr<SpeakerLearner> learner_;  // while somebody is met
  std::string learned_name_;

  std::unique_ptr<MouthTracker> tracker_;  // of the sound since it began anew
  RecordedMouth words_;                    // of the same
  bool best_ = true;                       // Mouth.mode
  SoundClock sound_clock_;
  std::unique_ptr<VoiceManner> manner_;  // none while neither head nor emotion is wanted
  const HeadNet* head_net_ = nullptr;
  bool emotion_on_ = false;
  std::uint64_t renewals_ = 0;  // so that poses by chance are others each time
  VoiceManner::Settings manner_settings_;
  std::string mood_ = "NEUTRAL";
  double mood_strength_ = 0;
  vm::Time start_{0};  // of the run being told
  bool stalled_ = false;
  vm::Time heard_{0};  // when sound came last
  vm::TimerId stall_timer_ = 0;
  vm::TimerId over_timer_ = 0;
  vm::TimerId end_timer_ = 0;  // when the mouth's last frame has passed
};

}  // namespace vdm
