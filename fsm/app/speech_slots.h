#pragma once

#include <optional>
#include <string>

#include "fsm/app/fsm_core.h"
#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/timer.h"

namespace fsm {

/// The slots of speech, whose states are:
///
///     IDLE --LipSync.pho--> PROCESSING --> READY --Speak--> SPEAKING --end or STOP--> IDLE
///
/// `Speak` before LipSync.pho is stored and executed as soon as the phonemes arrive. LipSync.pho
/// while SPEAKING is an error. The end and STOP report IDLE; Speak.len and Speak.utt are set then,
/// and reported with the next LipSync.pho.
class SpeechSlots final : public SlotGroup {
 public:
  /// Declares the slots. `core` outlives this.
  explicit SpeechSlots(FsmCore& core);

  /// Tells whether it speaks, or will at a known time.
  bool Busy() const override {
    return state_ == State::kSpeaking || (state_ == State::kReady && start_asked_);
  }
  void RestoreInitial() override;

 private:
  enum class State { kIdle, kProcessing, kReady, kSpeaking };

  void DeclareListSlots();
  void DeclareSpeakSlots();
  void DeclareSettings();
  vm::Result<std::string> Prepare(const std::string& text);
  vm::Result<void> Speak(const vm::SetValue& value);
  void Begin();
  void TellSpeaking(vm::Time start);
  void WaitForEnd();
  void Stop();
  void EndSpeech(vm::PhonemeList spoken);
  void SetState(State state);

  FsmCore& core_;
  State state_ = State::kIdle;
  vm::PhonemeList list_;
  std::string text_;                     // of the next utterance, until it starts
  bool start_asked_ = false;             // by Speak; until the utterance ends
  std::optional<vm::Time> asked_start_;  // none: as soon as the phonemes arrive
  vm::PhonemeList spoken_;               // of the previous utterance
  vm::Timer timer_{core_.clock};         // for the start or the end
};

}  // namespace fsm
