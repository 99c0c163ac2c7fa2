#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "fsm/rig/skin_weights.h"
#include "fsm/rig/unit_table.h"
#include "fsm/rig/unit_values.h"

namespace fsm {

/// The summed effects of the active units other than displacing skin.
struct UnitEffects {
  struct Lids {
    float upper_mm = 0, lower_mm = 0, close = 0;
  };
  Sided<Lids> lids;
  float jaw_degrees = 0, jaw_slide_mm = 0, jaw_sway_mm = 0;
  float seal = 0;
  float tongue_raise = 0, tongue_out_mm = 0;
};

/// Returns the summed effects of acting units (UnitCombiner) but for creases.
UnitEffects SumEffects(const UnitTable& table, const Sided<UnitValues>& au);
/// Returns the creases' depths in a state: `at_rest` plus what the acting units add.
Creases CreaseDepths(const UnitTable& table, const Sided<UnitValues>& au,
                     const std::array<float, kLastingCreases>& at_rest);
/// Returns how far a field, which the table has for the left, moves a vertex on `side`, in mm.
glm::vec3 FieldDisplacement(const UnitTable::Field& field, const SkinWeights& weights, Side side);

/// Returns the share, 0..1, of units of the agent's left side `x_mm` to the viewer's right of the
/// median: both sides meet within 7 mm of it. The rest is that of the right side.
float LeftShareAt(float x_mm);

}  // namespace fsm
