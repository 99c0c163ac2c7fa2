#pragma once

#include <string>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Which face is worn: MaskSet, NowMask and Mask.
class MaskSlots {
 public:
  /// `first`: the face at the start, "" = the studio's first. Throws std::runtime_error with a
  /// sentence if there is none of that name. `core` outlives this.
  MaskSlots(FsmCore& core, std::string first);
  void Reset();  ///< for `Run = INIT`; the motion is new

 private:
  vm::Result<void> Wear(const std::string& face);

  FsmCore& core_;
  std::string first_;
};

}  // namespace fsm
