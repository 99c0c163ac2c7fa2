#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

namespace facefit {

/// Returns the median; of an even number of values the upper middle one. REQUIRES: at least one
/// value.
inline float Median(std::vector<float> values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}
/// Returns the median of each channel. REQUIRES: as above.
inline glm::vec3 Median(const std::vector<glm::vec3>& colours) {
  glm::vec3 median;
  for (int c = 0; c < 3; ++c) {
    std::vector<float> channel;
    for (const glm::vec3& colour : colours) channel.push_back(colour[c]);
    median[c] = Median(std::move(channel));
  }
  return median;
}

}  // namespace facefit
