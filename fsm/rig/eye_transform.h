#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace fsm {

/// Where an eye with its lids sits in a face, as a change of where tables/eye.txt has it.
struct EyeTransform {
  glm::vec3 shift{0};  ///< of the ball's centre, millimetres
  float turn = 0;      ///< about the line of sight, radians, counter-clockwise to the viewer
  float size = 1;
  /// How far the rims of the open lids stand above the table's, millimetres before `size`.
  float upper_mm = 0, lower_mm = 0;

  /// A direction of the table's eye in the face.
  glm::vec3 Turned(glm::vec3 d) const {
    const float c = size * std::cos(turn), s = size * std::sin(turn);
    return {c * d.x - s * d.y, s * d.x + c * d.y, size * d.z};
  }
  /// A place of the table's eye, whose ball is at `centre`, in the face.
  glm::vec3 Placed(glm::vec3 centre, glm::vec3 p) const {
    return centre + shift + Turned(p - centre);
  }
};

}  // namespace fsm
