#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/render/skin_creases.h"
#include "fsm/rig/head.h"

namespace fsm {

/// What is visible at the vertices of a head, as vectors whose differences count as millimetres of
/// error: position and normal in extreme states of the face, colour, openness to light, texture
/// coordinates, creases, hairs.
class VertexFeatures {
 public:
  /// `creases`: those of the head, or empty.
  VertexFeatures(const Head& head, const CreaseWeights& creases);
  const glm::vec3& RestOf(std::uint32_t vertex) const { return Row(vertex)[0]; }
  /// Returns the square of the distance of a vertex from the point interpolated between three
  /// others. It stops when the result exceeds `max`.
  float Difference(std::uint32_t vertex, const std::array<std::uint32_t, 3>& corners,
                   glm::vec3 weights, float max) const {
    const glm::vec3* own = Row(vertex);
    const std::array between{Row(corners[0]), Row(corners[1]), Row(corners[2])};
    const float weight = importance_[vertex] * importance_[vertex];
    float worst = 0;
    for (std::size_t k = 0; k < count_ && worst <= max; ++k) {
      const glm::vec3 difference = own[k] - weights.x * between[0][k] - weights.y * between[1][k] -
                                   weights.z * between[2][k];
      worst = std::max(worst, weight * glm::dot(difference, difference));
    }
    return worst;
  }

 private:
  const glm::vec3* Row(std::uint32_t vertex) const { return values_.data() + vertex * count_; }
  std::size_t count_ = 0;  // per vertex
  std::vector<glm::vec3> values_;
  std::vector<float> importance_;  // by vertex: factor on its differences
};

}  // namespace fsm
