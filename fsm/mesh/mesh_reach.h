#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace fsm {

/// The greatest absolute value of a coordinate: of a file's positions in its unit after all
/// transformations, and of a head in our frame in millimetres (10 km). Squares and products of such
/// numbers do not overflow a float, and grid cells of a few millimetres can be indexed.
inline constexpr float kMaxMeshReach = 1e7F;

/// Returns false also for numbers that are not finite.
inline bool WithinReach(glm::vec3 p) {
  return std::abs(p.x) <= kMaxMeshReach && std::abs(p.y) <= kMaxMeshReach &&
         std::abs(p.z) <= kMaxMeshReach;
}

}  // namespace fsm
