#pragma once

#include <string>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slots that choose the face: MaskSet, NowMask and Mask.
class MaskSlots final : public SlotGroup {
 public:
  /// `initial`: the initial face, "" = the library's first. `listed`: the names that MaskSet
  /// reports. Names that the library does not have are left out, and if none remains, all faces
  /// are reported. Every face of the library can be selected, listed or not. Throws
  /// std::runtime_error if the library has no face `initial`. `core` outlives this.
  MaskSlots(FsmCore& core, std::string initial, const std::vector<std::string>& listed = {});
  void RestoreInitial() override;

 private:
  vm::Result<void> Select(const std::string& face);

  FsmCore& core_;
  std::string initial_, current_;
};

}  // namespace fsm
