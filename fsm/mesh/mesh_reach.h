#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace fsm {

/// How far from the origin places may lie, on each axis: those of a file in its own unit and with
/// all its transformations made, and those of a head placed in our frame in millimetres (10 km).
/// Squares and products of such numbers are still floats, and cells of a few millimetres between
/// them can be numbered; nobody's head is as large.
inline constexpr float kMaxMeshReach = 1e7F;

/// False too for what is no finite number.
inline bool WithinReach(glm::vec3 p) {
  return std::abs(p.x) <= kMaxMeshReach && std::abs(p.y) <= kMaxMeshReach &&
         std::abs(p.z) <= kMaxMeshReach;
}

}  // namespace fsm
