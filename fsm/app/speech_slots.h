#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "fsm/app/fsm_core.h"
#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/timer.h"

namespace fsm {

/// The speaking of the face as its slots tell it:
///
///     IDLE --LipSync.pho--> PROCESSING --> READY --Speak--> SPEAKING --end or STOP--> IDLE
///
/// `Speak` before the list is remembered and carried out as soon as the list is there. LipSync.pho
/// while SPEAKING is refused. The end and STOP always report len, utt and IDLE.
class SpeechSlots final : public ModulePart {
 public:
  struct Listener {
    /// SPEAKING was reached; the utterance stands from `start` on, now or just before.
    std::function<void(vm::Time start)> begun = [](vm::Time) {};
    std::function<void()> ended = [] {};  ///< IDLE was reached, but not by `Run = INIT`
  };
  /// Declares the slots. `core` outlives this.
  explicit SpeechSlots(FsmCore& core);
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  /// Speaking, or about to at a time that is known.
  bool Busy() const { return stat_ == Stat::kSpeaking || (stat_ == Stat::kReady && start_asked_); }
  void Reset() override;

 private:
  enum class Stat { kIdle, kProcessing, kReady, kSpeaking };

  void DeclareListSlots();
  void DeclareSpeakSlots();
  void DeclareSettings();
  vm::Result<std::string> Prepare(const std::string& text);
  vm::Result<void> Speak(const vm::SetValue& value);
  void Begin();
  void TellSpeaking();
  void WaitForEnd();
  void Stop();
  void End(vm::PhonemeList spoken);
  void SetStat(Stat stat);

  FsmCore& core_;
  Listener listener_;
  Stat stat_ = Stat::kIdle;
  vm::PhonemeList list_;
  std::string text_;               // of the list that comes, or has come and does not sound yet
  bool start_asked_ = false;       // by Speak, and not over
  std::optional<vm::Time> start_;  // asked for; none: as soon as the list is there
  vm::PhonemeList spoken_;         // of the utterance before
  vm::Timer timer_{core_.clock};   // the start or the end
};

}  // namespace fsm
