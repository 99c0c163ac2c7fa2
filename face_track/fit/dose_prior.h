#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "face_track/model/seen_face.h"

namespace facetrack {

/// How surely each of SeenFace::variations is not there: the inverse of its variance, mm^-2, by
/// what doses there are.
Eigen::VectorXf SureOfNone(const SeenFace& face, const std::vector<float>& doses);

/// How surely a turn that was found by other means is right, radians^-2 about each axis: it is off
/// by 0.3 degrees, and a face that is seen turned a little looks as if it did a little of
/// something.
inline constexpr float kUnsureOfTurn = 0.3F * std::numbers::pi_v<float> / 180;
inline constexpr float kSureOfTurn = 1 / (kUnsureOfTurn * kUnsureOfTurn);

/// What a dose costs beside what it explains, so that of units that look alike few are taken: the
/// logarithm of how large it is beside a small one, and so the less for more the larger it is.
/// `sureness`: of how much the picture tells of it, in parts of what is not sure of a point.
struct DoseCost {
  static constexpr float kStrength = 1.2F, kSmall = 0.1F;  // dose
  /// Nothing costs less than what is seen so well: else a large dose of a unit that hardly shows
  /// would explain what a small one of another does.
  static constexpr float kLeastSureness = 10;
  static float Slope(float sureness, float dose) {
    return kStrength * std::max(sureness, kLeastSureness) * kSmall / (kSmall + dose);
  }
  /// The integral of Slope from 0.
  static float Of(float sureness, float dose) {
    return kStrength * std::max(sureness, kLeastSureness) * kSmall * std::log1p(dose / kSmall);
  }
};

}  // namespace facetrack
