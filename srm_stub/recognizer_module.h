#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "ear/grammar/grammar.h"
#include "ear/grammar_shelf.h"
#include "ear/listening.h"
#include "ear/sound_keep.h"
#include "srm_stub/input_script.h"
#include "vm_protocol/core/module.h"

namespace srm_stub {

using Millis = std::chrono::milliseconds;

inline constexpr std::size_t kMaxQueuedInputs = 64;

/// The speech recognition module (SRM) with typed text for a microphone: what is "said" comes by
/// `Input.text` or from a script, takes time word by word if wished, and is matched against the
/// active grammars. What Listen.keep keeps of it is a tone as long as it took.
///
///   OFF --Run = START--> LISTENING --first word--> SPEECH --last word--> LISTENING
///                                        Result.partial ...   Result or NoMatch
///
/// Thread: the scheduler's. Exact on a virtual clock.
class RecognizerModule final : public vm::Module {
 public:
  using ReadFile = std::function<vm::Result<std::string>(const std::string& path)>;
  struct Options {
    std::string module_version{};
    ReadFile read_file{};
  };

  RecognizerModule(vm::Scheduler& scheduler, Options options);
  ~RecognizerModule() override;

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override;
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  struct Input {
    std::string text;
    vm::Reply reply;
    Millis sound{0};  ///< without words, for so long
  };

  void DeclareGrammar();
  void DeclareInput();

  void DropInputs(const vm::Error& why);
  void Take(Input input);
  void Hear(const Input& input);
  void HearWord(std::size_t count);
  void Until(vm::Time when, std::size_t words);
  void Finish();
  void KeepSound();
  void Recognize(const std::string& text);
  vm::Result<std::string> StartScript(const std::string& path);
  void NextScriptLine();

  vm::Scheduler& scheduler_;
  const Options options_;
  vm::SlotMachine slots_;

  ear::GrammarShelf<ear::Grammar> grammars_;
  ear::Listening listening_;
  ear::SoundKeep keep_;
  Millis word_time_{0};
  std::deque<Input> inputs_;          // the first one is being heard
  std::vector<std::string> written_;  // its words as written
  bool underway_ = false;             // it has begun
  std::size_t said_ = 0;              // of them, so far
  vm::Time heard_since_{0};
  vm::TimerId word_timer_ = 0;

  std::deque<ScriptLine> script_;
  vm::Time script_start_{0};
  vm::TimerId script_timer_ = 0;
  bool exit_requested_ = false;
};

}  // namespace srm_stub
