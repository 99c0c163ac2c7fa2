#pragma once

#include <string>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slots that choose the face: MaskSet, NowMask and Mask.
class MaskSlots final : public Activity {
 public:
  /// `first`: the initial face, "" = the wardrobe's first. `listed`: the names that MaskSet
  /// reports. Names that the wardrobe does not have are left out, and if none remains, all faces
  /// are reported. Every face of the wardrobe can be worn, listed or not. Throws std::runtime_error
  /// if the wardrobe has no face `first`. `core` outlives this.
  MaskSlots(FsmCore& core, std::string first, const std::vector<std::string>& listed = {});
  void Reset() override;

 private:
  vm::Result<void> Wear(const std::string& face);

  FsmCore& core_;
  std::string first_;
  std::string worn_;
};

}  // namespace fsm
