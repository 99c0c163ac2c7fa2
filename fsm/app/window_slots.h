#pragma once

#include "fsm/app/record_slots.h"

namespace fsm {

/// The slot Window: the size of the view, or a window that fills the screen.
class WindowSlots final : public SlotGroup {
 public:
  /// Declares the slot. The size stays while `record` makes a film. Both outlive this.
  WindowSlots(FsmCore& core, const RecordSlots& record);
  void RestoreInitial() override;

 private:
  vm::Result<void> FillScreen(bool fill);

  FsmCore& core_;
  int start_width_, start_height_;  // of the view
  bool fills_screen_ = false;
};

}  // namespace fsm
