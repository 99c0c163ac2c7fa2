#include "fsm/rig/normals.h"

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

namespace fsm {
namespace {

/// Adds the normals of triangles, by their areas, to those of their corners. `owner` says which
/// vertex keeps the normal of another.
void AddNormals(std::span<const std::uint32_t> triangles, std::span<const glm::vec3> position,
                std::span<glm::vec3> normal, const auto& owner) {
  for (std::size_t k = 0; k + 2 < triangles.size(); k += 3) {
    const glm::vec3 a = position[triangles[k]];
    const glm::vec3 n = glm::cross(position[triangles[k + 1]] - a, position[triangles[k + 2]] - a);
    for (std::size_t c = 0; c < 3; ++c) normal[owner(triangles[k + c])] += n;
  }
}

glm::vec3 Unit(glm::vec3 n) {
  const float squared = glm::dot(n, n);
  return squared > 1e-12f ? n / std::sqrt(squared) : glm::vec3(0, 0, 1);
}

}  // namespace

// Twin: STEP_normals in fsm/render/shaders/rig_steps.glsl.
void FindNormals(const NormalRig& rig, std::span<const std::uint32_t> soft,
                 std::span<const glm::vec3> position, std::span<glm::vec3> normal) {
  for (const std::uint32_t i : soft) normal[i] = glm::vec3(0);
  AddNormals(rig.soft_triangles, position, normal, [&](std::uint32_t i) { return rig.Owner(i); });
  for (const std::uint32_t i : soft) normal[i] = Unit(normal[i]);
  if (rig.twin.empty()) return;
  for (const std::uint32_t i : soft) normal[i] = normal[rig.Owner(i)];
}

std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count) {
  std::vector<glm::vec3> normal(count, glm::vec3(0));
  AddNormals(triangles, position, normal, std::identity());
  for (glm::vec3& n : normal) n = Unit(n);
  return normal;
}

}  // namespace fsm
