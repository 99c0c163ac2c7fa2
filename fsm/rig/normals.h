#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// Adds the normals of triangles, by their areas, to those of their corners, and makes them unit.
void Accumulate(std::span<const std::uint32_t> triangles, std::span<const glm::vec3> position,
                std::span<glm::vec3> normal);
/// Likewise from nothing, of `count` vertices.
std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count);

}  // namespace fsm
