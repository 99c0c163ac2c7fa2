#pragma once

#include "fsm/app/fsm_core.h"
#include "fsm/app/picture_stream.h"

namespace fsm {

/// The slots Picture.to and Picture.fps: pictures for another program.
class PictureSlots final : public SlotGroup {
 public:
  /// Declares the slots. `core` outlives this.
  explicit PictureSlots(FsmCore& core);
  void StopActivity() override { static_cast<void>(pictures_.SendTo("NONE", 1)); }
  void RestoreInitial() override { per_second_ = kPerSecond; }
  void OnChange() override { pictures_.Touch(); }

 private:
  static constexpr int kPerSecond = 25;

  FsmCore& core_;
  PictureStream pictures_;
  int per_second_ = kPerSecond;
};

}  // namespace fsm
