#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// The profile of the fitted head from `below_chin_mm` below the chin up: heights in even steps,
/// and how far forward.
std::vector<glm::vec3> ProfileOf(const FittedHead& fitted, float below_chin_mm);

/// Mean distance of outline and profile: another person's face lies farther off.
inline constexpr float kMaxProfileGapMm = 4;

/// Where the profile may lie in a picture.
struct ProfilePlacement {
  int direction = 1;  ///< 1: it looks to the right, -1: to the left
  float pixels_per_mm = 1;
  float tilt_rad = 0;
  glm::vec2 pixel{0};   ///< where `middle` is seen
  glm::vec3 middle{0};  ///< of the profile, head's frame
  glm::vec2 PixelOf(glm::vec3 place) const;
};

/// Where the outline of a figure (`opacity`: 1 = figure) is like the profile of the fitted head.
std::optional<ProfilePlacement> FindProfile(const FittedHead& fitted, const FloatImage& opacity);

}  // namespace facefit
