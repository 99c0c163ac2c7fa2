#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

namespace facefit {

/// A point on a mesh, inside a triangle.
struct MeshPoint {
  std::array<std::uint32_t, 3> corner{};
  glm::vec3 weight{1, 0, 0};  ///< of each corner, sum 1
  /// Returns the interpolated value of a vertex attribute there.
  template <typename Values>
  auto On(const Values& of_vertex) const {
    return of_vertex[corner[0]] * weight.x + of_vertex[corner[1]] * weight.y +
           of_vertex[corner[2]] * weight.z;
  }
};

}  // namespace facefit
