#pragma once

#include <optional>
#include <vector>

#include "fsm/rig/face_state.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// Finds how strongly action units really act. Immutable; thread: any.
class UnitCombiner {
 public:
  /// `asymmetry_seed` gives every unit but those of lids and jaw slightly different strengths on
  /// the two sides, the same for the same seed; none: both sides are alike.
  UnitCombiner(const UnitTable& table, std::optional<int> asymmetry_seed);
  /// Returns the strengths that act: clamped to 0..2, above 1 at half rate (tissue stops
  /// stretching), and corrected for units that act together. A non-finite value becomes 0.
  Sided<UnitValues> ActingUnits(const FaceState& state) const;

 private:
  std::vector<UnitTable::Rule> rules_;
  /// Extra strength per side as a fraction; 0.03 = 3 % stronger.
  Sided<UnitValues> lean_;
};

}  // namespace fsm
