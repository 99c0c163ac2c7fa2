#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "fsm/mesh/transfer/welded_surface.h"

namespace fsm {

/// Finds the nearest point of a surface that faces the same way, belongs to the same lip or lid and
/// is equally visible.
class SurfaceIndex {
 public:
  /// A triangle whose bounding box overlaps more grid cells than this is not found; no triangle of
  /// a face is that large. The edge of a cell is `reach` / 2, at least 1 mm.
  static constexpr std::int64_t kMaxCellsOfTriangle = 4096;
  /// The limit of the sum over all triangles. A face has one or two cells per triangle.
  static constexpr std::int64_t kMaxCells = 4 << 20;
  /// Throws std::runtime_error if there are more than kMaxCells. Lifetime: `surface` outlives this.
  /// REQUIRES: the surface is within kMaxReach.
  SurfaceIndex(const WeldedSurface& surface, float reach);
  struct Hit {
    std::uint32_t triangle;
    glm::vec3 barycentric, position;
    float distance_mm;
  };
  /// Returns the point nearest to a vertex of another surface, at most `reach` away. REQUIRES:
  /// ComputeVisibility was called for both.
  std::optional<Hit> Find(const WeldedSurface& other, std::size_t vertex) const;

 private:
  static std::int64_t Cell(glm::ivec3 c);
  const WeldedSurface& surface_;
  float reach_, cell_;
  std::vector<glm::vec3> low_, high_;  ///< corners of each triangle's bounding box
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace fsm
