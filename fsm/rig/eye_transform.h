#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace fsm {

/// How one eye with its lids is placed in a face, relative to its place in tables/eye.txt.
struct EyeTransform {
  glm::vec3 shift{0};  ///< of the eyeball's centre, millimetres
  float roll = 0;      ///< about the line of sight, radians, counter-clockwise to the viewer
  float size = 1;
  /// How far the open lids' margins stand above those of the table, in millimetres before `size`.
  float upper_mm = 0, lower_mm = 0;

  /// Maps a direction from the frame of the table's eye into the face.
  glm::vec3 Rotated(glm::vec3 d) const {
    const float c = size * std::cos(roll), s = size * std::sin(roll);
    return {c * d.x - s * d.y, s * d.x + c * d.y, size * d.z};
  }
  /// Maps a point of the table's eye, whose ball is centred at `centre`, into the face.
  glm::vec3 PointInFace(glm::vec3 centre, glm::vec3 p) const {
    return centre + shift + Rotated(p - centre);
  }
};

}  // namespace fsm
