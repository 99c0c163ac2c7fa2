#pragma once

#include <limits>
#include <span>
#include <vector>

#include "face_fit/fit/camera_pose.h"
#include "face_fit/fit/least_squares.h"

namespace facefit {

/// A point in the head's frame and where a photo shows it.
struct PointMatch {
  glm::vec3 position;
  glm::vec2 pixel;
  float weight = 1;
};

/// The unknowns of a pose in a least-squares fit. The focal length is represented by its logarithm,
/// so that it stays positive.
enum PoseParameter : std::size_t {
  kRotationX,
  kRotationY,
  kRotationZ,
  kLogFocal,
  kCentreX,
  kCentreY,
  kPoseParameters
};
/// Returns these unknowns in this order; rotations are limited to +-max_rotation_rad.
std::vector<Unknown> PoseUnknowns(
    const CameraPose& start, double max_rotation_rad = std::numeric_limits<double>::infinity());
/// Returns the pose. REQUIRES: at least kPoseParameters numbers.
CameraPose PoseFromParameters(std::span<const double> parameters);
/// Steps in which a fit of a pose converges, with or without an expression.
inline constexpr int kPoseRounds = 20;

/// Returns the pose that projects the matches nearest to their pixels, starting from `start`.
/// Distances above 3 mm count linearly, others squared.
CameraPose FitPose(std::span<const PointMatch> matches, const CameraPose& start);
/// Returns the pose with the given rotation that projects positions nearest to pixels.
CameraPose PoseWithRotation(const std::vector<glm::vec3>& positions,
                            const std::vector<glm::vec2>& pixels, glm::vec3 rotation_rad);
/// Returns the weighted mean distance between the matches' pixels and projected positions.
float MeanDistanceMm(const CameraPose& pose, std::span<const PointMatch> matches);

}  // namespace facefit
