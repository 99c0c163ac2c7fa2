#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/mesh/transfer/mesh_paths.h"

namespace fsm {

/// A surface with features by which points are matched: normals, the side of lips and lids, and
/// visibility. Vertices duplicated along texture seams are merged.
class WeldedSurface {
 public:
  /// `has_uv_seams`: whether to merge vertices at the same position whose normals agree.
  WeldedSurface(std::span<const glm::vec3> given_position, std::span<const std::uint32_t> triangles,
                bool has_uv_seams);

  std::vector<glm::vec3> position, normal;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Neighbours neighbours;
  std::vector<std::uint32_t> welded_of;  ///< given vertex -> welded one; kNone: in no triangle
  std::vector<std::uint32_t> given_of;   ///< welded vertex -> one of the given
  /// Per vertex, whether it belongs to upper (1) or lower (-1) lip and lid, 0 = neither.
  std::vector<float> lip, lid;
  /// Per vertex, the visibility from the front: 1 = visible, 0 = more than a few millimetres behind
  /// a visible surface, as the linings of mouths and eye sockets. Set by ComputeVisibility.
  std::vector<float> visibility;
  static constexpr std::uint32_t kNone = 0xffffffffU;

  void ComputeNormals();
  /// Computes `visibility`. `eyes`: triangles of the eyeballs, indices into `given_position`, which
  /// hide what is behind them. A triangle whose bounding box covers more than a square metre hides
  /// nothing. Throws std::runtime_error if the boxes together cover more than kMaxCovered, as
  /// hundreds of layers of triangles would. REQUIRES: everything is within kMaxReach.
  static constexpr std::int64_t kMaxCovered = 1 << 28;  ///< square millimetres
  void ComputeVisibility(std::span<const glm::vec3> given_position,
                         std::span<const std::uint32_t> eyes);
  /// Returns the mean length of the edges of a vertex; 0 if it has none.
  float MeanEdge(std::size_t vertex) const;
  std::uint32_t Nearest(glm::vec3 p) const;
  /// Returns, per vertex, the distance along edges to the nearest of the vertices closest to the
  /// seeds, clamped to `reach`.
  std::vector<float> DistancesFrom(std::span<const glm::vec3> seeds, float reach) const;
};

}  // namespace fsm
