#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>

namespace fsm {

/// The smallest axis-aligned box that contains every point added to it.
struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{-low};

  static Box Of(std::span<const glm::vec3> places) {
    Box box;
    for (const glm::vec3& place : places) box.Add(place);
    return box;
  }
  void Add(const glm::vec3& place) {
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  bool empty() const { return low.x > high.x; }
  glm::vec3 centre() const { return 0.5f * (low + high); }
  glm::vec3 size() const { return high - low; }
  glm::vec3 radii() const { return 0.5f * size(); }
};

}  // namespace fsm
