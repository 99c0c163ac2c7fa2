#pragma once

#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "face_fit/find/network/network_points.h"

namespace facefit {

/// Returns which corners of a face coincide, a clause, or nothing if none do: the outer corners of
/// the eyes must lie apart, because they give a face's size, and those of the mouth, because lips
/// are measured along them. `pixel_of(point)`: the pixel of a point of the network.
std::optional<std::string> CoincidingCorners(auto pixel_of) {
  constexpr float kNearestPx = 4;
  const auto apart = [&](PointIndex a, PointIndex b) {
    return glm::distance(pixel_of(a), pixel_of(b)) >= kNearestPx;
  };
  if (!apart(point::kEyeOuterRight, point::kEyeOuterLeft)) {
    return "the outer corners of the eyes lie in one place";
  }
  if (!apart(point::kMouthRight, point::kMouthLeft)) {
    return "the corners of the mouth lie in one place";
  }
  return std::nullopt;
}

}  // namespace facefit
