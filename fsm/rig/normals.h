#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// Says which vertices get their normals from the moved mesh.
struct NormalRig {
  /// Triangles, three indices each, whose corners get normals computed from their moved positions.
  /// All other vertices keep their rest normals, rotated with their bone.
  std::vector<std::uint32_t> soft_triangles;
  /// Per vertex the one whose normal it shares across a texture seam; may be empty.
  std::vector<std::uint32_t> twin;

  std::uint32_t Owner(std::uint32_t vertex) const { return twin.empty() ? vertex : twin[vertex]; }
};
/// Computes the normals of `soft`, which lists each corner of the soft triangles once.
void ComputeNormals(const NormalRig& rig, std::span<const std::uint32_t> soft,
                    std::span<const glm::vec3> position, std::span<glm::vec3> normal);

/// Returns the unit normals of `count` vertices as area-weighted means of their triangles' normals.
std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count);

}  // namespace fsm
