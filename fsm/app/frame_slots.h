#pragma once

#include <optional>
#include <string>

#include "fsm/app/fsm_core.h"
#include "fsm/app/record_slots.h"

namespace fsm {

/// Reports on frames: the slot Frame reports each frame drawn; the module named by Frame.to is sent
/// the state of the face (FaceFrame).
class FrameSlots final : public SlotGroup {
 public:
  /// Declares the slots. `core` and `record` outlive this.
  FrameSlots(FsmCore& core, const RecordSlots& record);
  void RestoreInitial() override;

  void OnFilmFrame(long number, vm::Time at) override { Report(number, at); }
  /// Tells whether frames that belong to no film are reported. In a film its own are.
  bool wanted() const { return (is_reported() && !record_.recording()) || !to_.empty(); }
  /// Reports a frame that belongs to no film, numbered from the start of the program.
  void ReportShown(vm::Time at);

 private:
  bool is_reported() const { return core_.slots.AutoOutput("Frame"); }
  void Report(long number, vm::Time at);
  /// Sends the message for the face at `at` to the module of Frame.to, if there is one.
  void SendState(vm::Time at);

  FsmCore& core_;
  const RecordSlots& record_;
  long shown_ = 0;
  std::string to_;                              // the receiving module; empty: none
  std::optional<std::string> unmeasured_face_;  // the face whose head could not be measured
};

}  // namespace fsm
