#include "face_fit/fit/pose_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

namespace facefit {
namespace {

glm::vec2 OffsetMm(const CameraPose& pose, const PointMatch& match) {
  return (pose.PixelOf(match.position) - match.pixel) / pose.PixelsPerMm();
}

}  // namespace

std::vector<Unknown> PoseUnknowns(const CameraPose& start, double max_rotation_rad) {
  constexpr double kTurnStepRad = 1e-3, kFocalStep = 1e-3, kCentreStep = 0.5;
  std::vector<Unknown> unknowns;
  for (int axis = 0; axis < 3; ++axis) {
    unknowns.push_back({.start = start.rotation_rad[axis],
                        .step = kTurnStepRad,
                        .low = -max_rotation_rad,
                        .high = max_rotation_rad});
  }
  unknowns.push_back({.start = std::log(static_cast<double>(start.focal_px)), .step = kFocalStep});
  unknowns.push_back({.start = start.centre_px.x, .step = kCentreStep});
  unknowns.push_back({.start = start.centre_px.y, .step = kCentreStep});
  return unknowns;
}

CameraPose PoseFromParameters(std::span<const double> parameters) {
  assert(parameters.size() >= kPoseParameters);
  const auto value = [&](PoseParameter p) { return static_cast<float>(parameters[p]); };
  return {.rotation_rad = {value(kRotationX), value(kRotationY), value(kRotationZ)},
          .focal_px = std::exp(value(kLogFocal)),
          .centre_px = {value(kCentreX), value(kCentreY)}};
}

CameraPose FitPose(std::span<const PointMatch> matches, const CameraPose& start) {
  constexpr float kPlainMm = 3;
  constexpr double kMaxTurnRad = 1.6;
  const auto residuals = [&](const std::vector<double>& parameters) {
    const CameraPose pose = PoseFromParameters(parameters);
    std::vector<double> out;
    for (const PointMatch& match : matches) {
      const glm::vec2 offset = OffsetMm(pose, match);
      const float distance = glm::length(offset);
      const float weight =
          match.weight * (distance > kPlainMm ? std::sqrt(kPlainMm / distance) : 1.0F);
      out.push_back(static_cast<double>(weight * offset.x));
      out.push_back(static_cast<double>(weight * offset.y));
    }
    return out;
  };
  return PoseFromParameters(
      LevenbergMarquardt(residuals, PoseUnknowns(start, kMaxTurnRad), kPoseRounds));
}

CameraPose PoseWithRotation(const std::vector<glm::vec3>& positions,
                            const std::vector<glm::vec2>& pixels, glm::vec3 rotation_rad) {
  CameraPose pose{.rotation_rad = rotation_rad};
  LinearLeastSquares equations;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::vec2 u = pose.PixelOf(positions[i]);
    equations.Add({static_cast<double>(u.x), 1, 0}, static_cast<double>(pixels[i].x));
    equations.Add({static_cast<double>(u.y), 0, 1}, static_cast<double>(pixels[i].y));
  }
  const auto solved = equations.Solve(1e-12);
  pose.focal_px = static_cast<float>(solved[0]);
  pose.centre_px = {static_cast<float>(solved[1]), static_cast<float>(solved[2])};
  return pose;
}

float MeanDistanceMm(const CameraPose& pose, std::span<const PointMatch> matches) {
  float sum = 0, weight = 0;
  for (const PointMatch& match : matches) {
    sum += match.weight * glm::length(OffsetMm(pose, match));
    weight += match.weight;
  }
  return sum / std::max(weight, 1e-6F);
}

}  // namespace facefit
