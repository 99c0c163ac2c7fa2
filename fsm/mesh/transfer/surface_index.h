#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "fsm/mesh/transfer/welded_surface.h"

namespace fsm {

/// Finds the nearest place of a surface that faces the same way, belongs to the same lip or lid and
/// is as well seen.
class SurfaceIndex {
 public:
  /// A triangle whose box lies in more cells than this (of half `reach`, at least a millimetre) is
  /// left out: it is part of no face, and nothing comes to lie on it.
  static constexpr std::int64_t kMaxCellsOfTriangle = 4096;
  /// Over all triangles. A face has one or two for each.
  static constexpr std::int64_t kMaxCells = 4 << 20;
  /// Throws std::runtime_error if there are more than kMaxCells. REQUIRES: all of the surface,
  /// which outlives this, lies within kMaxMeshReach.
  SurfaceIndex(const WeldedSurface& surface, float reach);
  struct Hit {
    std::uint32_t triangle;
    glm::vec3 part, at;
    float far;  ///< millimetres
  };
  /// What the vertex of another surface lies nearest to. REQUIRES: FindSeen was called for both.
  std::optional<Hit> Find(const WeldedSurface& other, std::size_t vertex) const;

 private:
  static std::int64_t Cell(glm::ivec3 c);
  const WeldedSurface& surface_;
  float reach_, cell_;
  std::vector<glm::vec3> low_, high_;  ///< corners of each triangle's box
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace fsm
