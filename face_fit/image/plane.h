#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>

namespace facefit {

// Geometry in a plane. Pure; thread: any.

/// Rotates a point about (0, 0) from x towards y.
inline glm::vec2 Rotated(glm::vec2 p, float angle_rad) {
  const float c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

/// Returns the angle of a direction from x towards y, -pi..pi.
inline float AngleOf(glm::vec2 direction) { return std::atan2(direction.y, direction.x); }

/// A point of a grid and its eight neighbours, as offsets.
inline constexpr std::array<glm::ivec2, 9> kAround = {
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

/// The bounding box of points; low > high while there are none.
struct Box2 {
  glm::vec2 low{1e9F}, high{-1e9F};
  void Add(glm::vec2 p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  glm::vec2 Middle() const { return 0.5F * (low + high); }
  glm::vec2 Size() const { return high - low; }
};

inline float DistanceToSegment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
  const glm::vec2 along = b - a;
  const float t = glm::dot(p - a, along) / std::max(glm::dot(along, along), 1e-6F);
  return glm::distance(p, a + glm::clamp(t, 0.0F, 1.0F) * along);
}

/// Returns y at `x` of a polyline ordered by x; beyond its ends, y of the nearer end. REQUIRES: at
/// least two points.
template <typename Point>
float LineYAt(std::span<const Point> line, float x) {
  assert(line.size() >= 2);
  std::size_t k = 1;
  while (k + 1 < line.size() && line[k].x < x) ++k;
  const float t = (x - line[k - 1].x) / std::max(line[k].x - line[k - 1].x, 1e-3F);
  return glm::mix(line[k - 1].y, line[k].y, glm::clamp(t, 0.0F, 1.0F));
}

}  // namespace facefit
