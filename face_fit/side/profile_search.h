#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/image/photo_edge.h"
#include "face_fit/image/raster.h"

namespace facefit {

/// Returns the profile of the fitted head upward from `below_chin_mm` below the chin: the foremost
/// points at equal steps of height, head's frame.
std::vector<glm::vec3> ProfileOf(const FittedHead& fitted, float below_chin_mm);

/// Greatest mean distance of outline and profile; other people's faces mostly exceed it.
inline constexpr float kMaxProfileGapMm = 4;

/// Where an image shows the profile.
struct ProfilePlacement {
  PhotoEdge towards = PhotoEdge::kRight;  ///< the side that the face looks to
  float pixels_per_mm = 1;
  float tilt_rad = 0;
  glm::vec2 pixel{0};   ///< the projection of `middle`
  glm::vec3 middle{0};  ///< middle of the profile, head's frame
  glm::vec2 PixelOf(glm::vec3 position) const;
};

/// Returns where the outline of a figure (`opacity`: 1 = figure) resembles the fitted head's
/// profile most; nothing if it does nowhere.
std::optional<ProfilePlacement> FindProfile(const FittedHead& fitted, const Mask& opacity);

}  // namespace facefit
