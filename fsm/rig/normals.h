#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// Normals that follow what a state makes of the vertices.
struct NormalRig {
  /// Triangles whose corners take their normals from what they become, three indices each; all
  /// other vertices keep theirs, turned with their bone.
  std::vector<std::uint32_t> soft_triangles;
  /// Per vertex the one whose normal it shares, where a texture is sewn together; may be empty.
  std::vector<std::uint32_t> twin;

  std::uint32_t Owner(std::uint32_t vertex) const { return twin.empty() ? vertex : twin[vertex]; }
};
/// Fills the normals of `soft`, the corners of the soft triangles, each once.
void FindNormals(const NormalRig& rig, std::span<const std::uint32_t> soft,
                 std::span<const glm::vec3> position, std::span<glm::vec3> normal);

/// The unit normals of `count` vertices: those of their triangles, weighted by area.
std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count);

}  // namespace fsm
