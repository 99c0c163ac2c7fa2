#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/mesh/transfer/mesh_paths.h"

namespace fsm {

/// A surface with what tells its places apart beside where they are. Vertices at one place that
/// belong to one sheet (a seam of the texture) are one here.
class WeldedSurface {
 public:
  /// `weld`: whether vertices at one place are made one; else only triangles are taken over.
  WeldedSurface(std::span<const glm::vec3> position, std::span<const std::uint32_t> triangles,
                bool weld);

  std::vector<glm::vec3> at, normal;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Neighbours next;
  std::vector<std::uint32_t> of;  ///< welded vertex of each given one, kNone if no triangle has it
  std::vector<std::uint32_t> first;  ///< a given vertex of each welded one
  /// Where the vertex lies between opposites: 1 = upper, -1 = lower, 0 = neither.
  std::vector<float> lip, lid;
  /// 1 = seen from the front, 0 = more than a few millimetres behind what is seen there, as the
  /// linings of mouths and eye sockets. Filled by FindSeen.
  std::vector<float> seen;
  static constexpr std::uint32_t kNone = 0xffffffffU;

  void FindNormals();
  /// `eyes`: triangles of the eyeballs, which hide what lies behind them; of the vertices
  /// `position`. A triangle whose box covers more than a square metre hides nothing.
  /// Throws std::runtime_error if all of them together cover more than kMaxCovered, as triangles
  /// do that lie in hundreds of layers. REQUIRES: all lies within kMaxMeshReach.
  static constexpr std::int64_t kMaxCovered = 1 << 28;  ///< square millimetres of their boxes
  void FindSeen(std::span<const glm::vec3> position, std::span<const std::uint32_t> eyes);
  std::uint32_t Nearest(glm::vec3 p) const;
  /// Distances along edges from the vertices nearest to the seeds, up to `reach`; beyond it
  /// `reach`.
  std::vector<float> DistancesFrom(std::span<const glm::vec3> seeds, float reach) const;
};

}  // namespace fsm
