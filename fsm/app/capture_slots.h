#pragma once

#include <string>

#include "fsm/app/capture.h"
#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slot Capture: numbered pictures of an utterance.
class CaptureSlots final : public SlotGroup {
 public:
  /// Declares the slot. `core` outlives this.
  explicit CaptureSlots(FsmCore& core);
  void StopActivity() override { capture_.Cancel(); }
  void OnSpeechBegin(vm::Time start) override { capture_.Begin(start); }
  void OnSpeechEnd() override;
  bool Busy() const override { return capture_.running(); }

 private:
  vm::Result<std::string> Set(const vm::SetValue& value);

  FsmCore& core_;
  Capture capture_;
};

}  // namespace fsm
