#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace facefit {

/// A triangle in a plane, in any unit. Pure.
struct Triangle2 {
  glm::vec2 a, b, c;

  /// Returns twice the area; the sign gives the orientation of the corners.
  float SignedArea() const { return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y); }
  /// Returns the barycentric coordinates of a point: of a, b and c, sum 1, negative beyond the
  /// opposite edge. REQUIRES: SignedArea() is not 0.
  glm::vec3 WeightsAt(glm::vec2 p) const {
    const float area = SignedArea();
    const float u = ((p.x - a.x) * (c.y - a.y) - (c.x - a.x) * (p.y - a.y)) / area;
    const float v = ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y)) / area;
    return {1 - u - v, u, v};
  }
};

/// Calls `f(x, y, weights)` for each point with whole coordinates 0 <= x < columns, 0 <= y < rows
/// in a triangle of either orientation. `slack`: how far weights may fall below 0, so that no point
/// on an edge between two triangles is lost. Triangles without area have no points.
template <typename F>
void Rasterize(const Triangle2& triangle, int columns, int rows, float slack, F f) {
  constexpr float kMinArea = 1e-7F;
  if (!(std::abs(triangle.SignedArea()) >= kMinArea)) return;
  const auto& [a, b, c] = triangle;
  const glm::vec2 from = glm::max(glm::floor(glm::min(a, glm::min(b, c))), 0.0F);
  const glm::vec2 to =
      glm::min(glm::ceil(glm::max(a, glm::max(b, c))), glm::vec2(columns - 1, rows - 1));
  for (int y = static_cast<int>(from.y); y <= static_cast<int>(to.y); ++y) {
    for (int x = static_cast<int>(from.x); x <= static_cast<int>(to.x); ++x) {
      const glm::vec3 weights = triangle.WeightsAt(glm::vec2(x, y));
      if (std::min({weights.x, weights.y, weights.z}) >= -slack) f(x, y, weights);
    }
  }
}

}  // namespace facefit
