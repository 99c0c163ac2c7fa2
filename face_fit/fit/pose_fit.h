#pragma once

#include <limits>
#include <span>
#include <vector>

#include "face_fit/fit/camera_pose.h"
#include "face_fit/fit/least_squares.h"

namespace facefit {

/// A point in the head's frame and where a photo shows it.
struct PointMatch {
  glm::vec3 place;
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
/// Those unknowns, in that order; no turn goes beyond `max_turn_rad` to either side.
std::vector<Unknown> PoseUnknowns(const CameraPose& start,
                                  double max_turn_rad = std::numeric_limits<double>::infinity());
/// REQUIRES: kPoseParameters numbers or more.
CameraPose PoseOf(std::span<const double> parameters);
/// So many steps settle a pose, with and without an expression.
inline constexpr int kPoseRounds = 20;

/// The pose that shows the matches nearest to where the photo shows them, starting from `start`.
/// Matches more than 3 mm off count by their distance, not by its square.
CameraPose RefinePose(std::span<const PointMatch> matches, const CameraPose& start);
/// The pose that shows places nearest to pixels, with the turn as given.
CameraPose PoseWithTurn(const std::vector<glm::vec3>& places, const std::vector<glm::vec2>& pixels,
                        glm::vec3 turn_rad);
/// The mean distance between the matches and where a pose projects them, each by its weight.
float MeanDistanceMm(const CameraPose& pose, std::span<const PointMatch> matches);

}  // namespace facefit
