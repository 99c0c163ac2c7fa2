#pragma once

#include <span>

#include "face_fit/fit/fit.h"

namespace facefit {

/// A place in the head's frame and where a photo shows it.
struct PoseMark {
  glm::vec3 at;
  glm::vec2 pixel;
  float weight = 1;
};

/// The pose nearest to `start` in which the marks lie where they are shown; marks far off count by
/// their distance, not by its square.
Pose SettlePose(std::span<const PoseMark> marks, const Pose& start);
/// Mean distance of marks from where they are shown, millimetres.
float MeanOff(const Pose& pose, std::span<const PoseMark> marks);

}  // namespace facefit
