#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace fsm {

/// The greatest absolute value of a coordinate: of a file's positions in its unit after all
/// transformations, and of a head in our frame in millimetres (10 km). Squares and products of such
/// numbers do not overflow a float, and grid cells of a few millimetres can be indexed.
inline constexpr float kMaxReach = 1e7f;
inline constexpr const char* kMaxReachOfHead = "10 km";  ///< as messages word it for a head

/// Returns false also for numbers that are not finite.
inline bool WithinReach(glm::vec3 p) {
  return std::abs(p.x) <= kMaxReach && std::abs(p.y) <= kMaxReach && std::abs(p.z) <= kMaxReach;
}

}  // namespace fsm
