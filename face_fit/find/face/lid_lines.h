#pragma once

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "face_fit/find/network/found_face.h"
#include "face_fit/image/plane.h"

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
  explicit LidLines(const EyePoints& points) : origin_(points[0]) {
    const glm::vec2 axis = points[kInnerCorner] - points[0];
    width_ = std::max(glm::length(axis), 1e-3F);
    along_axis_ = axis / width_;
    down_axis_ = {-along_axis_.y, along_axis_.x};
    if (glm::dot(points[kLowerMiddle] - points[kUpperMiddle], down_axis_) < 0)
      down_axis_ = -down_axis_;
    const auto in_eye = [this](glm::vec2 p) { return glm::vec2(Along(p), Down(p)); };
    for (std::size_t k = 0; k <= kInnerCorner; ++k) {
      upper_[k] = in_eye(points[k]);
      lower_[k] = in_eye(points[(points.size() - k) % points.size()]);
    }
  }
  float width() const { return width_; }
  glm::vec2 along_axis() const { return along_axis_; }  ///< unit
  glm::vec2 down_axis() const { return down_axis_; }    ///< unit

  float Along(glm::vec2 p) const { return glm::dot(p - origin_, along_axis_) / width_; }
  float Down(glm::vec2 p) const { return glm::dot(p - origin_, down_axis_); }
  glm::vec2 PointAt(float along, float down) const {
    return origin_ + along * width_ * along_axis_ + down * down_axis_;
  }
  LidHeights LidsAt(float along) const {
    return {LineYAt<glm::vec2>(upper_, along), LineYAt<glm::vec2>(lower_, along)};
  }

 private:
  glm::vec2 origin_;  // the outer corner
  float width_ = 1;
  glm::vec2 along_axis_, down_axis_;
  std::array<glm::vec2, kInnerCorner + 1> upper_, lower_;  // along and down, from corner to corner
};

}  // namespace facefit
