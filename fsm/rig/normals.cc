#include "fsm/rig/normals.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fsm {

namespace {

glm::vec3 Unit(glm::vec3 n) {
  const float squared = glm::dot(n, n);
  return squared > 1e-12f ? n / std::sqrt(squared) : glm::vec3(0, 0, 1);
}

}  // namespace

void FindNormals(const NormalRig& rig, std::span<const std::uint32_t> soft,
                 std::span<const glm::vec3> position, std::span<glm::vec3> normal) {
  for (const std::uint32_t i : soft) normal[i] = glm::vec3(0);
  const std::vector<std::uint32_t>& t = rig.soft_triangles;
  for (std::size_t k = 0; k + 2 < t.size(); k += 3) {
    const glm::vec3 a = position[t[k]];
    const glm::vec3 n = glm::cross(position[t[k + 1]] - a, position[t[k + 2]] - a);
    for (std::size_t c = 0; c < 3; ++c) normal[rig.Owner(t[k + c])] += n;
  }
  for (const std::uint32_t i : soft) normal[i] = Unit(normal[i]);
  if (rig.twin.empty()) return;
  for (const std::uint32_t i : soft) normal[i] = normal[rig.Owner(i)];
}

void Accumulate(std::span<const std::uint32_t> triangles, std::span<const glm::vec3> position,
                std::span<glm::vec3> normal) {
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    const glm::vec3 n = glm::cross(position[b] - position[a], position[c] - position[a]);
    normal[a] += n;
    normal[b] += n;
    normal[c] += n;
  }
  for (glm::vec3& n : normal) n = Unit(n);
}

std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count) {
  std::vector<glm::vec3> normal(count, glm::vec3(0));
  Accumulate(triangles, position, normal);
  return normal;
}

}  // namespace fsm
