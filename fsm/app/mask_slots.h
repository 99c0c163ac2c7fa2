#pragma once

#include <string>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Which face is worn: MaskSet, NowMask and Mask.
class MaskSlots {
 public:
  /// `first`: the face at the start, "" = the backend's first. `listed`: the faces MaskSet tells
  /// of, as far as the backend has them; if it has none of them, MaskSet tells of all. The others
  /// can be worn all the same. Throws std::runtime_error with a sentence if there is none of the
  /// first name. `core` outlives this.
  MaskSlots(FsmCore& core, std::string first, const std::vector<std::string>& listed = {});
  void Reset();  ///< for `Run = INIT`; the motion is new

 private:
  vm::Result<void> Wear(const std::string& face);

  FsmCore& core_;
  std::string first_;
};

}  // namespace fsm
