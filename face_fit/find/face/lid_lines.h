#pragma once

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "face_fit/find/network/found_face.h"

namespace facefit {

/// The points of point::kEyeOutline: from the outer corner along the upper lid to the inner corner,
/// and back along the lower lid; points of both lids lie above each other.
using EyePoints = std::array<glm::vec2, 16>;
/// `point_at(point)`: where a point of the network lies.
EyePoints EyePointsOf(fsm::Side side, auto point_at) {
  EyePoints points;
  std::ranges::transform(point::kEyeOutline[side], points.begin(), point_at);
  return points;
}
inline EyePoints EyePointsOf(fsm::Side side, const FoundFace& face) {
  return EyePointsOf(side, [&face](PointIndex i) { return face.PixelOf(i); });
}

/// Returns the share of a lid's movement at `x` between the corners of an eye: 1 in the middle, 0
/// at the corners and beyond. All arguments are x coordinates.
inline float LidShare(float x, float inner, float outer) {
  const float along = 2 * (x - inner) / (outer - inner) - 1;
  return std::max(1 - along * along, 0.0F);
}

/// Where both lids of an eye are, as `down` of LidLines.
struct LidHeights {
  float upper, lower;
};

/// The lines of both lids in coordinates of the eye: `along` the line between its corners, 0 at the
/// outer and 1 at the inner one; `down`, the distance from that line towards the lower lid. Works
/// in pixels (y down) and in millimetres (y up).
class LidLines {
 public:
  explicit LidLines(const EyePoints& points) : points_(points) {
    const glm::vec2 axis = points[kInnerCorner] - points[0];
    width_ = std::max(glm::length(axis), 1e-3F);
    along_axis_ = axis / width_;
    down_axis_ = {-along_axis_.y, along_axis_.x};
    if (glm::dot(points[kLowerMiddle] - points[kUpperMiddle], down_axis_) < 0)
      down_axis_ = -down_axis_;
  }
  float width() const { return width_; }
  glm::vec2 along_axis() const { return along_axis_; }  ///< unit
  glm::vec2 down_axis() const { return down_axis_; }    ///< unit

  float Along(glm::vec2 p) const { return glm::dot(p - points_[0], along_axis_) / width_; }
  float Down(glm::vec2 p) const { return glm::dot(p - points_[0], down_axis_); }
  glm::vec2 PointAt(float along, float down) const {
    return points_[0] + along * width_ * along_axis_ + down * down_axis_;
  }
  LidHeights LidsAt(float along) const {
    const auto between = [this, along](std::size_t a, std::size_t b) {
      const float from = Along(points_[a]), to = Along(points_[b % points_.size()]);
      const float share = glm::clamp((along - from) / std::max(to - from, 1e-4F), 0.0F, 1.0F);
      return glm::mix(Down(points_[a]), Down(points_[b % points_.size()]), share);
    };
    std::size_t upper = 1, lower = points_.size() - 1;
    while (upper < kInnerCorner && Along(points_[upper]) < along) ++upper;
    while (lower > kInnerCorner && Along(points_[lower]) < along) --lower;
    return {between(upper - 1, upper),
            lower + 1 == points_.size() ? between(0, lower) : between(lower + 1, lower)};
  }

 private:
  EyePoints points_;
  float width_ = 1;
  glm::vec2 along_axis_, down_axis_;
};

}  // namespace facefit
