#include "face_fit/fit/pose_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/fit/least_squares.h"

namespace facefit {
namespace {

Pose PoseOf(const std::array<double, 6>& p) {
  const auto f = [&p](std::size_t i) { return static_cast<float>(p[i]); };
  return {{f(0), f(1), f(2)}, std::exp(f(3)), {f(4), f(5)}};
}

glm::vec2 Off(const Pose& pose, const PoseMark& mark) {
  return (pose.Project(pose.ToCamera(mark.at)) - mark.pixel) / pose.PixelsPerMm();
}

}  // namespace

Pose SettlePose(std::span<const PoseMark> marks, const Pose& start) {
  const auto residuals = [&](const std::array<double, 6>& p) {
    const Pose pose = PoseOf(p);
    std::vector<double> out;
    for (const PoseMark& mark : marks) {
      const glm::vec2 by = Off(pose, mark);
      constexpr float kPlain = 3;  // millimetres
      const float off = glm::length(by);
      const float w = mark.weight * (off > kPlain ? std::sqrt(kPlain / off) : 1.0F);
      out.push_back(static_cast<double>(w * by.x));
      out.push_back(static_cast<double>(w * by.y));
    }
    return out;
  };
  const auto d = [](float v) { return static_cast<double>(v); };
  return PoseOf(GaussNewton<6>(residuals,
                               {d(start.turn.x), d(start.turn.y), d(start.turn.z),
                                std::log(d(start.focal)), d(start.centre.x), d(start.centre.y)},
                               {1e-3, 1e-3, 1e-3, 1e-3, 0.5, 0.5}, 10,
                               [](std::array<double, 6>& p) {
                                 for (std::size_t i = 0; i < 3; ++i)
                                   p[i] = std::clamp(p[i], -1.6, 1.6);
                               }));
}

float MeanOff(const Pose& pose, std::span<const PoseMark> marks) {
  float sum = 0, weight = 0;
  for (const PoseMark& mark : marks) {
    sum += mark.weight * glm::length(Off(pose, mark));
    weight += mark.weight;
  }
  return sum / std::max(weight, 1e-6F);
}

}  // namespace facefit
