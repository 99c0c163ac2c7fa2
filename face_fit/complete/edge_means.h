#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace facefit {

/// Colours along an edge, as means over any part of it.
class EdgeMeans {
 public:
  /// The next pixel of the edge; what has no weight is not known.
  void Add(glm::vec3 value, float weight) {
    sums_.push_back(sums_.back() + glm::vec4(value * weight, weight));
  }
  /// The mean over up to `reach` pixels to either side, what is nearer counting more, 0 where
  /// nothing is known; and how much is known, 0..1.
  glm::vec4 MeanAround(float at, float reach) const {
    glm::vec4 sum(0);
    for (const float part : {1.0F, 0.6F, 0.3F}) sum += Sum(at, part * reach) / 3.0F;
    return {glm::vec3(sum) / std::max(sum.w, 1e-4F), sum.w};
  }
  /// The mean of all.
  glm::vec3 All() const { return glm::vec3(sums_.back()) / std::max(sums_.back().w, 1e-4F); }

 private:
  /// The sum divided by the number of pixels.
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
