#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace facefit {

/// A place on a mesh: between the corners of a triangle.
struct MeshPoint {
  std::array<std::uint32_t, 3> corner{};
  glm::vec3 part{1, 0, 0};  ///< of each corner, sum 1
  glm::vec3 On(std::span<const glm::vec3> vertices) const {
    return vertices[corner[0]] * part.x + vertices[corner[1]] * part.y +
           vertices[corner[2]] * part.z;
  }
};

}  // namespace facefit
