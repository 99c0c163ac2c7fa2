#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/base/unit_list.h"
#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Combines the layers of all sources at one instant into a state of the face, by the rules of
/// tables/mixing.txt. A value, constant after Read; thread: any.
class Mixer {
 public:
  /// Reads the rules. Errors: kBadValue "NAME:LINE: ..." for a malformed row, and for names that no
  /// earlier row declares.
  static vm::Result<Mixer> Read(const std::string& name, std::string_view text);

  /// Sets the units, mouth, head, eyes and lids of `state`; the rest is unchanged. `regions` gives
  /// the group of each unit. REQUIRES: made by Read.
  void Mix(const MotionLayers& layers, const UnitRegions& regions, FaceState& state) const;

 private:
  class Reader;
  struct Rules;  ///< the table
  std::shared_ptr<const Rules> rules_;
};

}  // namespace fsm
