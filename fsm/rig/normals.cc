#include "fsm/rig/normals.h"

#include <functional>

#include "fsm/rig/steps.h"

namespace fsm {
namespace {

/// Adds the area-weighted normals of triangles to those of their corners. `owner` maps a vertex to
/// the one that accumulates its normal.
void AddNormals(std::span<const std::uint32_t> triangles, std::span<const glm::vec3> position,
                std::span<glm::vec3> normal, const auto& owner) {
  for (std::size_t k = 0; k + 2 < triangles.size(); k += 3) {
    const glm::vec3 n = step::TriangleNormal(position[triangles[k]], position[triangles[k + 1]],
                                             position[triangles[k + 2]]);
    for (std::size_t c = 0; c < 3; ++c) normal[owner(triangles[k + c])] += n;
  }
}

}  // namespace

void ComputeNormals(const NormalRig& rig, std::span<const std::uint32_t> soft,
                    std::span<const glm::vec3> position, std::span<glm::vec3> normal) {
  for (const std::uint32_t i : soft) normal[i] = glm::vec3(0);
  AddNormals(rig.soft_triangles, position, normal, [&](std::uint32_t i) { return rig.Owner(i); });
  for (const std::uint32_t i : soft) normal[i] = step::UnitNormal(normal[i]);
  if (rig.twin.empty()) return;
  for (const std::uint32_t i : soft) normal[i] = normal[rig.Owner(i)];
}

std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count) {
  std::vector<glm::vec3> normal(count, glm::vec3(0));
  AddNormals(triangles, position, normal, std::identity());
  for (glm::vec3& n : normal) n = step::UnitNormal(n);
  return normal;
}

}  // namespace fsm
