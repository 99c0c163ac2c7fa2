#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "face_fit/find/network/network_crop.h"
#include "face_fit/find/network/network_points.h"

namespace facefit {

/// A face with its points: x and y in pixels of the image, y down; z in the same unit towards the
/// viewer, 0 near the middle of the head.
struct FoundFace {
  PerPoint<glm::vec3> points = {};
  float certainty = 0;  ///< confidence, 0..1, that the points lie on a face
  float score = 1;      ///< of the detector, 0..1; it finds no face that is upside down
  NetworkCrop crop;     ///< around the points
  glm::vec2 PixelOf(PointIndex i) const { return glm::vec2(points[i]); }
  /// Returns the way from the right eye's outer corner to the left one's, pixels.
  glm::vec2 AcrossEyes() const {
    return PixelOf(point::kEyeOuterLeft) - PixelOf(point::kEyeOuterRight);
  }
  std::vector<glm::vec2> Line(std::span<const PointIndex> of) const {
    std::vector<glm::vec2> line;
    for (const PointIndex i : of) line.push_back(PixelOf(i));
    return line;
  }
};

/// Returns whether the lips are parted, so that teeth or the dark of the mouth show between them.
inline bool LipsApart(const FoundFace& face) {
  const auto apart = [&face](PointIndex a, PointIndex b) {
    return glm::distance(face.PixelOf(a), face.PixelOf(b));
  };
  // Distance of the middles of the inner lips, divided by the mouth's width.
  constexpr float kMinGap = 0.06F;
  return apart(point::kInnerLipTop, point::kInnerLipBottom) >
         kMinGap * apart(point::kMouthRight, point::kMouthLeft);
}

/// Certainty below which there is no face: a few images of other things reach 0.66; people and
/// drawn heads hardly fall below 0.9.
inline constexpr float kCertainFace = 0.75F;

}  // namespace facefit
