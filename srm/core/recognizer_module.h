#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ear/grammar_shelf.h"
#include "ear/listening.h"
#include "ear/result_report.h"
#include "ear/sound_keep.h"
#include "sound/audio_source.h"
#include "srm/core/ear.h"
#include "srm/engine/echo_canceller.h"
#include "srm/engine/transcriber.h"
#include "vm_protocol/core/module.h"

namespace srm {

/// The speech recognition module (SRM). Its slots and reports are those of srm_stub, and more.
///
///   OFF --Run = START--> LISTENING --speech begins--> SPEECH --silence--> LISTENING
///                                      Result.partial ...       Result or NoMatch
///
/// Thread: the scheduler's.
class RecognizerModule final : public vm::Module {
 public:
  struct Options {
    std::string module_version{};
    std::string languages = "*";  ///< Listen.languages
    std::function<vm::Result<std::string>(const std::string& path)> read_file{};
    /// The engines, made when first needed.
    std::function<vm::Result<std::unique_ptr<SpeechDecoder>>()> open_decoder{};
    std::function<vm::Result<std::unique_ptr<KeywordSpotter>>()> open_spotter{};
    /// Who has the words of an utterance in place of the decoder; empty: the decoder has them.
    std::unique_ptr<Transcriber> transcriber{};
    /// A source by name: wav:PATH, raw:PATH, portaudio[:DEVICE].
    std::function<vm::Result<std::unique_ptr<sound::AudioSource>>(const std::string&)>
        open_source{};
  };

  RecognizerModule(vm::Scheduler& scheduler, Options options);
  ~RecognizerModule() override;

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override;
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  enum class Echo { kHalf, kOpen, kCancel };
  // recognizer_slots.cc
  void DeclareListen();
  void DeclareLanguages();
  void DeclareAgent();
  void DeclareGrammar();
  void DeclareInput();
  void DeclareResult();

  // recognizer_module.cc
  vm::Result<Ear*> NeedEar();
  vm::Result<void> UseGrammars();
  vm::Result<std::string> LoadGrammar(const std::string& name, const std::string& text);
  vm::Result<std::string> DropGrammar(const std::string& name);
  vm::Result<std::string> ActivateGrammars(const vm::SetValue& value);
  // recognizer_listening.cc
  vm::Result<std::string> SetInput(const std::string& source);
  vm::Result<std::string> SetSpot(const std::string& phrases);
  vm::Result<void> StartSource();
  vm::Result<std::string> SetVoice(const std::string& source);
  vm::Result<void> StartVoice();
  void SetEcho(Echo echo);
  void Hear(std::span<const std::int16_t> samples);
  void StopListening();
  void OnBegan();
  void OnEnded(const Ear::Heard& heard);
  void OnSourceOver();
  /// What was said, as text, until `end`; `heard` is null for typed text.
  void Recognize(const std::string& text, const Ear::Heard* heard, vm::Time end);
  /// Whether more need not be waited for.
  bool IsWhole(const std::string& text) const;
  std::optional<ear::Candidate> Understand(const std::string& text, double confidence) const;
  void SetAgentSpeaking(bool speaking);

  vm::Scheduler& scheduler_;
  const Options options_;
  vm::SlotMachine slots_;

  std::unique_ptr<Ear> ear_;  // null until needed
  bool grammars_used_ = false;
  std::unique_ptr<sound::AudioSource> source_;
  std::string source_name_ = "NONE";
  vm::Time source_start_{0};

  ear::GrammarShelf<ear::Grammar> grammars_;
  std::vector<std::pair<std::string, std::string>> pronunciations_;

  ear::Listening listening_;
  ear::SoundKeep keep_;
  bool agent_speaking_ = false;
  Echo echo_ = Echo::kHalf;
  std::unique_ptr<EchoCanceller> canceller_;   // while echo_ is kCancel
  std::unique_ptr<sound::AudioSource> voice_;  // the agent's own, for it
  std::string voice_name_ = "NONE";
  double threshold_ = 0.5;
  std::size_t most_ = 1;
  Endpointer::Settings endpoints_;
  vm::TimerId over_timer_ = 0;
  bool exit_requested_ = false;
};

}  // namespace srm
