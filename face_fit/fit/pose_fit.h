#pragma once

#include <span>

#include "face_fit/fit/camera_pose.h"

namespace facefit {

/// A point in the head's frame and where a photo shows it.
struct PointMatch {
  glm::vec3 at;
  glm::vec2 pixel;
  float weight = 1;
};

/// A pose as unknowns of a least-squares fit. Of the focal length the logarithm is taken, so that
/// it stays above 0.
enum PoseParameter : std::size_t {
  kTurnX,
  kTurnY,
  kTurnZ,
  kLogFocal,
  kCentreX,
  kCentreY,
  kPoseParameters
};
/// REQUIRES: kPoseParameters numbers or more.
CameraPose PoseOf(std::span<const double> parameters);

/// The pose that shows the matches nearest to where the photo shows them, starting from `start`.
/// Marks more than 3 mm off count by their distance, not by its square.
CameraPose RefinePose(std::span<const PointMatch> matches, const CameraPose& start);
/// The pose that shows places nearest to pixels, with the turn as given.
CameraPose PoseWithTurn(const std::vector<glm::vec3>& places, const std::vector<glm::vec2>& pixels,
                        glm::vec3 turn);
/// A pose, and the mean distance of what it was found by from what it shows of the head.
struct PoseFit {
  CameraPose pose;
  float residual_mm = 0;
};
/// Mean distance of matches from where they are shown, millimetres.
float MeanDistanceMm(const CameraPose& pose, std::span<const PointMatch> matches);

}  // namespace facefit
