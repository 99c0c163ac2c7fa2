#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace facefit {

/// Values along an edge, averaged over any piece of it in constant time (prefix sums).
class EdgeMeans {
 public:
  /// Appends the next pixel of the edge. `weight`: 0..1; 0 means that the value is unknown.
  void Add(glm::vec3 value, float weight) {
    sums_.push_back(sums_.back() + glm::vec4(value * weight, weight));
  }
  /// Returns in x, y, z the mean over `reach` pixels to either side of pixel `at`, near pixels
  /// weighing more, or 0 if none is known; in w the known share of these pixels, 0..1.
  glm::vec4 MeanAround(float at, float reach) const {
    glm::vec4 sum(0);
    for (const float share : {1.0F, 0.6F, 0.3F}) sum += Sum(at, share * reach) / 3.0F;
    return {glm::vec3(sum) / std::max(sum.w, 1e-4F), sum.w};
  }
  /// Returns the mean of all known pixels, 0 if there are none.
  glm::vec3 All() const { return glm::vec3(sums_.back()) / std::max(sums_.back().w, 1e-4F); }

 private:
  /// Returns sums over the pixels within reach, divided by their number.
  glm::vec4 Sum(float at, float reach) const {
    const int count = static_cast<int>(sums_.size()) - 1;
    if (count < 1) return glm::vec4(0);
    const int from = std::clamp(static_cast<int>(std::floor(at - reach)), 0, count - 1);
    const int to = std::clamp(static_cast<int>(std::ceil(at + reach)), from + 1, count);
    return (sums_[static_cast<std::size_t>(to)] - sums_[static_cast<std::size_t>(from)]) /
           static_cast<float>(to - from);
  }

  std::vector<glm::vec4> sums_{glm::vec4(0)};
};

}  // namespace facefit
