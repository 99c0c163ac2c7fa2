#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace facefit {

/// A colour, 0..255, and how much it covers, 0..1.
struct Paint {
  glm::vec3 colour{0};
  float opacity = 0;
};

/// A place beyond a photo: how far below or above it and how far aside, pixels, not negative.
struct Beyond {
  float below, above, aside;
  std::size_t side;  ///< 0 left, 1 right
};

/// A photo on a larger canvas. Places are in the photo's pixels, also beyond it.
struct Canvas {
  glm::ivec2 photo;       ///< the pixel of the canvas that shows the photo's first
  glm::ivec2 photo_size;  ///< pixels, as `size`
  glm::ivec2 size;
  float per_mm;    ///< pixels
  glm::vec2 chin;  ///< place

  Beyond BeyondPhoto(glm::vec2 p) const {
    const glm::vec2 end(photo_size);
    return {std::max(p.y - end.y, 0.0F), std::max(-p.y, 0.0F), std::max({-p.x, p.x - end.x, 0.0F}),
            p.x < 0 ? 0U : 1U};
  }
};

/// Colours along an edge, as means over any part of it.
class EdgeMeans {
 public:
  /// The next pixel of the edge; what has no weight is not known.
  void Add(glm::vec3 value, float weight) {
    sums_.push_back(sums_.back() + glm::vec4(value * weight, weight));
  }
  /// The mean over up to `reach` pixels to either side, what is nearer counting more, 0 where
  /// nothing is known; and how much is known, 0..1.
  glm::vec4 Around(float at, float reach) const {
    glm::vec4 sum(0);
    for (const float part : {1.0F, 0.6F, 0.3F}) sum += Sum(at, part * reach) / 3.0F;
    return {glm::vec3(sum) / std::max(sum.w, 1e-4F), sum.w};
  }
  /// The mean of all.
  glm::vec3 All() const { return glm::vec3(sums_.back()) / std::max(sums_.back().w, 1e-4F); }

 private:
  /// By the length of what is summed up.
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
