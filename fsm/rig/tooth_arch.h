#pragma once

#include <glm/vec3.hpp>

#include "fsm/rig/steps.h"

namespace fsm {

/// Moves teeth and tongue from their place in the base head to that in a face: a shift, and a
/// rotation towards a side as of the face's lips, which a shear replaces at so small an angle.
struct TeethTransform {
  glm::vec3 shift{0};
  float slope = 0;  ///< forward, per millimetre to the left
  glm::vec3 operator()(glm::vec3 p) const { return p + shift + glm::vec3(0, 0, slope * p.x); }
};

using step::ToothArch;

inline ToothArch Moved(ToothArch arch, const TeethTransform& to) {
  arch.front_z += to.shift.z;
  arch.edge_y += to.shift.y;
  arch.root_y += to.shift.y;
  arch.middle_x += to.shift.x;
  arch.slope += to.slope;
  return arch;
}

/// Returns how steeply the arch (step::ArchZ) falls back at `x`, per millimetre outward.
inline float ArchSlope(const ToothArch& arch, float x) {
  const float offset = x - arch.middle_x;
  const float t = (offset / arch.half_width) * (offset / arch.half_width);
  const float steep = 2 * step::kArchSquare + 4 * step::kArchFourth * t;
  return arch.depth * steep * offset / (arch.half_width * arch.half_width) - arch.slope;
}

}  // namespace fsm
