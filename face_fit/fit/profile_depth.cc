#include "face_fit/fit/profile_depth.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "face_fit/fit/landmark_warp.h"
#include "face_fit/fit/profile_search.h"

namespace facefit {
namespace {

// How depth is corrected. Millimetres.
constexpr float kReach = 13;  // before and behind the line, where the outline is looked for
constexpr float kReachStep = 0.5F;
constexpr float kEven = 2.2F;         // height over which gaps are evened out (Gaussian sigma)
constexpr float kWide = 24;           // from the middle of the face: there 1/e of the gap counts
constexpr float kMostCorrection = 6;  // in one round
constexpr int kProfileRounds = 3;

/// How far before (or behind) a place of the profile the outline lies, millimetres of depth;
/// nothing beyond reach.
std::optional<float> DepthGap(const FloatImage& opacity, const CameraPose& pose, glm::vec3 p) {
  const auto inside = [&](float by) {
    const glm::vec2 at = pose.Pixel(p + glm::vec3(0, 0, by));
    return opacity.Between(at.x, at.y) - 0.5F;
  };
  if (inside(kReach) > 0) return {};
  for (float by = kReach - kReachStep; by >= -kReach; by -= kReachStep) {
    const float here = inside(by);
    if (here <= 0) continue;
    const float beyond = inside(by + kReachStep);
    return by + kReachStep * here / std::max(here - beyond, 1e-6F);
  }
  return {};
}

float MeanDepthGap(const FloatImage& opacity, const CameraPose& pose,
                   const std::vector<glm::vec3>& line) {
  float sum = 0;
  for (const glm::vec3& p : line) {
    sum += std::abs(DepthGap(opacity, pose, p).value_or(kReach)) / static_cast<float>(line.size());
  }
  return sum;
}

/// Scale, place and lean of the profile once more, from where the outline really is.
CameraPose FitPoseToOutline(const FloatImage& opacity, CameraPose pose,
                            const std::vector<glm::vec3>& line) {
  for (int round = 0; round < 6; ++round) {
    std::vector<glm::vec3> places;
    std::vector<glm::vec2> pixels;
    for (const glm::vec3& p : line) {
      const auto by = DepthGap(opacity, pose, p);
      if (!by) continue;
      places.push_back(p);
      pixels.push_back(pose.Pixel(p + glm::vec3(0, 0, *by)));
    }
    if (places.size() < line.size() / 2) return pose;
    CameraPose best = pose;
    float off = MeanDepthGap(opacity, pose, line);
    for (const float lean : {-2.0F, -1.0F, -0.4F, 0.0F, 0.4F, 1.0F, 2.0F}) {
      const CameraPose next =
          PoseWithTurn(places, pixels, pose.turn + glm::vec3(0, 0, glm::radians(lean)));
      const float at = MeanDepthGap(opacity, next, line);
      if (at >= off) continue;
      off = at;
      best = next;
    }
    pose = best;
  }
  return pose;
}

/// What depth lacks at heights along the profile, evened out.
class DepthGaps {
 public:
  DepthGaps(const FloatImage& opacity, const CameraPose& pose, const std::vector<glm::vec3>& line) {
    for (const glm::vec3& p : line) {
      if (const auto gap = DepthGap(opacity, pose, p)) gaps_.emplace_back(p.y, *gap);
    }
  }
  float At(float height) const {
    float sum = 0, weights = 1e-3F;
    for (const auto& [y, gap] : gaps_) {
      const float off = (y - height) / kEven;
      const float weight = std::exp(-0.5F * off * off);
      sum += weight * gap;
      weights += weight;
    }
    return sum / weights;
  }

 private:
  std::vector<std::pair<float, float>> gaps_;  // heights and depths, millimetres
};

/// Moves the targets of the fit forward or back by the gaps, the less the farther they lie beside
/// the middle of the face, and warps the head again.
void CorrectDepth(const DepthGaps& gaps, Fit& fit) {
  for (LandmarkConstraint& constraint : fit.targets.constraints) {
    const glm::vec3 p = constraint.on_head.On(fit.head.posed_vertices);
    const float weight = std::exp(-p.x * p.x / (kWide * kWide));
    constraint.z += weight * std::clamp(gaps.At(p.y), -kMostCorrection, kMostCorrection);
  }
  WarpToLandmarks(fit.targets, fit.head);
}

}  // namespace

std::optional<PoseFit> RefineDepthByProfile(const FloatImage& opacity, Fit& fit) {
  const auto placement = FindProfile(fit.head, opacity);
  const auto line = ProfileOf(fit.head, 1);
  if (!placement) return std::nullopt;
  std::vector<glm::vec2> pixels;
  for (const glm::vec3& p : line) pixels.push_back(placement->At(p));
  PoseFit view;
  view.pose = PoseWithTurn(
      line, pixels,
      {0, glm::radians(90.0F) * static_cast<float>(placement->direction), -placement->tilt});
  view.pose = FitPoseToOutline(opacity, view.pose, line);
  view.residual_mm = MeanDepthGap(opacity, view.pose, line);
  if (view.residual_mm > kMostProfileOffMm) return std::nullopt;
  for (int round = 0; round < kProfileRounds; ++round) {
    const auto now = ProfileOf(fit.head, 1);
    if (round > 0) view.pose = FitPoseToOutline(opacity, view.pose, now);
    CorrectDepth(DepthGaps(opacity, view.pose, now), fit);
  }
  return view;
}

}  // namespace facefit
