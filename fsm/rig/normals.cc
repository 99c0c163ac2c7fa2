#include "fsm/rig/normals.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fsm {

void Accumulate(std::span<const std::uint32_t> triangles, std::span<const glm::vec3> position,
                std::span<glm::vec3> normal) {
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    const glm::vec3 n = glm::cross(position[b] - position[a], position[c] - position[a]);
    normal[a] += n;
    normal[b] += n;
    normal[c] += n;
  }
  for (glm::vec3& n : normal) {
    const float squared = glm::dot(n, n);
    n = squared > 1e-12f ? n / std::sqrt(squared) : glm::vec3(0, 0, 1);
  }
}

std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count) {
  std::vector<glm::vec3> normal(count, glm::vec3(0));
  Accumulate(triangles, position, normal);
  return normal;
}

}  // namespace fsm
