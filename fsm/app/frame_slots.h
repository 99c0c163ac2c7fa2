#pragma once

#include <optional>
#include <string>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Reports on frames: the slot Frame reports each frame drawn; the module named by Frame.to is sent
/// the state of the face (FaceFrame).
class FrameSlots final : public ModulePart {
 public:
  /// Declares the slots. `core` outlives this.
  explicit FrameSlots(FsmCore& core);
  void Reset() override;

  void OnFrame(long number, vm::Time at) override { Report(number, at); }
  /// Reports a frame that belongs to no film, numbered from the start of the program.
  void ReportShown(vm::Time at) { Report(shown_++, at); }
  /// Sends the message for the face at `at` to the module of Frame.to, if there is one.
  void SendState(vm::Time at);
  bool is_reported() const { return core_.slots.AutoOutput("Frame"); }
  bool is_sent() const { return !to_.empty(); }

 private:
  void Report(long number, vm::Time at);

  FsmCore& core_;
  long shown_ = 0;
  std::string to_;                              // the receiving module; empty: none
  std::optional<std::string> unmeasured_mask_;  // the face whose head could not be measured
};

}  // namespace fsm
