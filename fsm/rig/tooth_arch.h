#pragma once

#include <glm/vec3.hpp>

#include "fsm/rig/step_constants.h"

namespace fsm {

/// Where teeth and tongue lie in a face, from the base head's places: moved, and turned towards a
/// side so far as its lips are, which for so small an angle is a shear.
struct TeethTransform {
  glm::vec3 shift{0};
  float slope = 0;  ///< forward for each millimetre to the left
  glm::vec3 operator()(glm::vec3 p) const { return p + shift + glm::vec3(0, 0, slope * p.x); }
};

/// One row of teeth: the outer faces lie on a parabola, flattened in front by a part of fourth
/// order (dental arches are nearer to a U than to a V).
struct ToothArch {
  float front_z, depth, half_width;
  float edge_y;  ///< of the middle incisors
  float root_y;  ///< where the gum ends
  float middle_x = 0;
  float turn = 0;  ///< as TeethTransform::slope
  /// Twin: ArchAt in fsm/render/shaders/rig_steps.glsl.
  float At(float x) const {
    const float off = x - middle_x;
    const float t = (off / half_width) * (off / half_width);
    return front_z + turn * off - depth * t * (step::kArchSquare + step::kArchFourth * t);
  }
  ToothArch Moved(const TeethTransform& to) const {
    ToothArch moved = *this;
    moved.front_z += to.shift.z;
    moved.edge_y += to.shift.y;
    moved.root_y += to.shift.y;
    moved.middle_x += to.shift.x;
    moved.turn += to.slope;
    return moved;
  }
  float Slope(float x) const {
    const float off = x - middle_x;
    const float t = (off / half_width) * (off / half_width);
    const float steep = 2 * step::kArchSquare + 4 * step::kArchFourth * t;
    return depth * steep * off / (half_width * half_width) - turn;
  }
};

}  // namespace fsm
