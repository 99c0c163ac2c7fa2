#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// The profile of the fitted head from `below_chin` millimetres below the chin up: heights in even
/// steps, and how far forward.
std::vector<glm::vec3> ProfileOf(const FittedHead& fitted, float below_chin);

/// Mean distance of outline and profile, millimetres: another person's face lies farther off.
inline constexpr float kMostProfileOffMm = 4;

/// Where the profile may lie: the place of its middle, pixels by millimetre, how it leans.
struct ProfilePlacement {
  int direction = 1;  ///< 1: it looks to the right, -1: to the left
  float scale = 1, tilt = 0, row = 0, column = 0;
  float off = 1e9F;        ///< mean distance, millimetres
  float concordance = -1;  ///< of both lines without their slopes, -1..1
  glm::vec3 middle{0};
  glm::vec2 At(glm::vec3 p) const;  ///< in pixels
};

/// Where the outline of a figure (`opacity`: 1 = figure) is like the profile of the fitted head.
std::optional<ProfilePlacement> FindProfile(const FittedHead& fitted, const FloatImage& opacity);

}  // namespace facefit
