#pragma once

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>

#include "face_fit/find/network/network_points.h"

namespace facefit {

/// The points of EyeOutline: from the outer corner along the upper lid to the inner corner, and
/// back along the lower lid; points of both lids lie above each other.
using EyePoints = std::array<glm::vec2, 16>;

/// Returns the share of a lid's movement at `x` between the corners of an eye: 1 in the middle, 0
/// at the corners and beyond. All arguments are x coordinates.
inline float LidOpening(float x, float inner, float outer) {
  const float along = 2 * (x - inner) / (outer - inner) - 1;
  return std::max(1 - along * along, 0.0F);
}

/// The lines of both lids in coordinates of the eye: `part` of the way from the outer corner (0) to
/// the inner one (1); `down`, the distance from the line between the corners towards the lower lid.
/// Works in pixels (y down) and in millimetres (y up).
class LidLines {
 public:
  explicit LidLines(const EyePoints& points) : points_(points) {
    const glm::vec2 axis = points[kInnerCorner] - points[0];
    wide_ = std::max(glm::length(axis), 1e-3F);
    along_ = axis / wide_;
    down_ = {-along_.y, along_.x};
    if (glm::dot(points[kLowerMiddle] - points[kUpperMiddle], down_) < 0) down_ = -down_;
  }
  float wide() const { return wide_; }
  glm::vec2 along() const { return along_; }  ///< unit
  glm::vec2 down() const { return down_; }    ///< unit

  float Part(glm::vec2 p) const { return glm::dot(p - points_[0], along_) / wide_; }
  float Down(glm::vec2 p) const { return glm::dot(p - points_[0], down_); }
  glm::vec2 PointAt(float part, float down) const {
    return points_[0] + part * wide_ * along_ + down * down_;
  }
  /// Returns `down` of the upper and of the lower lid.
  std::pair<float, float> LidsAt(float part) const {
    const auto between = [this, part](std::size_t a, std::size_t b) {
      const float from = Part(points_[a]), to = Part(points_[b % points_.size()]);
      const float way = glm::clamp((part - from) / std::max(to - from, 1e-4F), 0.0F, 1.0F);
      return glm::mix(Down(points_[a]), Down(points_[b % points_.size()]), way);
    };
    std::size_t upper = 1, lower = points_.size() - 1;
    while (upper < kInnerCorner && Part(points_[upper]) < part) ++upper;
    while (lower > kInnerCorner && Part(points_[lower]) < part) --lower;
    return {between(upper - 1, upper),
            lower + 1 == points_.size() ? between(0, lower) : between(lower + 1, lower)};
  }

 private:
  EyePoints points_;
  float wide_ = 1;
  glm::vec2 along_, down_;
};

}  // namespace facefit
