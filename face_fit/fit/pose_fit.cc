#include "face_fit/fit/pose_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/fit/least_squares.h"

namespace facefit {
namespace {

glm::vec2 OffsetMm(const CameraPose& pose, const PointMatch& match) {
  return (pose.Pixel(match.at) - match.pixel) / pose.PixelsPerMm();
}

}  // namespace

CameraPose PoseOf(std::span<const double> parameters) {
  const auto value = [&](PoseParameter p) { return static_cast<float>(parameters[p]); };
  return {.turn = {value(kTurnX), value(kTurnY), value(kTurnZ)},
          .focal = std::exp(value(kLogFocal)),
          .centre = {value(kCentreX), value(kCentreY)}};
}

CameraPose RefinePose(std::span<const PointMatch> matches, const CameraPose& start) {
  const auto residuals = [&](const std::vector<double>& p) {
    const CameraPose pose = PoseOf(p);
    std::vector<double> out;
    for (const PointMatch& match : matches) {
      const glm::vec2 by = OffsetMm(pose, match);
      constexpr float kPlain = 3;  // millimetres
      const float off = glm::length(by);
      const float w = match.weight * (off > kPlain ? std::sqrt(kPlain / off) : 1.0F);
      out.push_back(static_cast<double>(w * by.x));
      out.push_back(static_cast<double>(w * by.y));
    }
    return out;
  };
  constexpr double kMostTurn = 1.6;  // radians
  std::vector<Unknown> unknowns;
  for (int i = 0; i < 3; ++i) {
    unknowns.push_back(
        {.start = start.turn[i], .step = 1e-3, .low = -kMostTurn, .high = kMostTurn});
  }
  unknowns.push_back({.start = std::log(static_cast<double>(start.focal)), .step = 1e-3});
  unknowns.push_back({.start = start.centre.x, .step = 0.5});
  unknowns.push_back({.start = start.centre.y, .step = 0.5});
  return PoseOf(LevenbergMarquardt(residuals, unknowns, 20));
}

CameraPose PoseWithTurn(const std::vector<glm::vec3>& places, const std::vector<glm::vec2>& pixels,
                        glm::vec3 turn) {
  CameraPose pose{.turn = turn};
  LinearLeastSquares sum;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec2 u = pose.Pixel(places[i]);
    sum.Add({static_cast<double>(u.x), 1, 0}, static_cast<double>(pixels[i].x));
    sum.Add({static_cast<double>(u.y), 0, 1}, static_cast<double>(pixels[i].y));
  }
  const auto solved = sum.Solve(1e-12);
  pose.focal = static_cast<float>(solved[0]);
  pose.centre = {static_cast<float>(solved[1]), static_cast<float>(solved[2])};
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
