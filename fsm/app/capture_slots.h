#pragma once

#include <string>

#include "fsm/app/capture.h"
#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slot Capture: numbered pictures of an utterance.
class CaptureSlots final : public ModulePart {
 public:
  /// Declares the slot. `core` outlives this, and so does what `draw` uses.
  CaptureSlots(FsmCore& core, Capture::Draw draw);
  void End() override { capture_.Cancel(); }
  Capture& capture() { return capture_; }
  const Capture& capture() const { return capture_; }

 private:
  vm::Result<std::string> Set(const vm::SetValue& value);

  FsmCore& core_;
  Capture capture_;
};

}  // namespace fsm
