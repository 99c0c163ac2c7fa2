#pragma once

#include <optional>
#include <string>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// What is told of each frame: the slot Frame of what is drawn, and Frame.to, another module that
/// learns how the face is moved.
class FrameSlots final : public ModulePart {
 public:
  /// Declares the slots. `core` outlives this.
  explicit FrameSlots(FsmCore& core);
  void Reset() override;

  /// Draws the face as it is at `at`, and reports it as frame `number`.
  vm::Result<void> Draw(long number, vm::Time at);
  /// Reports a frame that belongs to no film, by its number since the start.
  void ReportShown(vm::Time at) { Report(shown_++, at); }
  /// Tells the module of Frame.to, if there is one.
  void Tell(vm::Time at);
  bool is_reported() const { return core_.slots.AutoOutput("Frame"); }
  bool is_told() const { return !to_.empty(); }

 private:
  void Report(long number, vm::Time at);

  FsmCore& core_;
  long shown_ = 0;
  std::string to_;                              // the module that is told each frame; empty: none
  std::optional<std::string> unmeasured_mask_;  // the face whose head could not be measured
};

}  // namespace fsm
