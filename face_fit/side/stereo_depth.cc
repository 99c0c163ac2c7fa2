#include "face_fit/side/stereo_depth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "face_fit/side/stereo.h"
#include "fsm/head/warp.h"

namespace facefit {
namespace {

constexpr int kStereoRounds = 2;
// Half the width of the strip in the middle of the face that both photos see.
constexpr float kMiddleMm = 12;
constexpr float kMaxDepthStepMm = 10;  // in one round
// Outliers: depths that differ by more than kMistakenMm from a warp of all depths, smoothed by
// kRoughSmoothMm, are dropped. At least kMinDepths must remain; they are smoothed by kDepthSmoothMm
// (both as in fsm::Warp).
constexpr float kMistakenMm = 2, kRoughSmoothMm = 60, kDepthSmoothMm = 12;
constexpr std::size_t kMinDepths = 20;

/// Copies depths of the near cheek to the far one, which the photo hides.
std::vector<PatchDepth> OnBothCheeks(std::vector<PatchDepth> depths, glm::vec3 towards) {
  const std::size_t count = depths.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [position, nearer_mm] = depths[i];
    if (position.x * towards.x > 0 && std::abs(position.x) > kMiddleMm) {
      depths.push_back({position * glm::vec3(-1, 1, 1), nearer_mm});
    }
  }
  return depths;
}

/// Returns a warp whose z smooths the depths.
fsm::Warp DepthWarp(const std::vector<PatchDepth>& depths, float smooth_mm) {
  std::vector<fsm::WarpPoint> points;
  for (const auto& [at_rest, nearer_mm] : depths) points.push_back({at_rest, {0, 0, nearer_mm}});
  return fsm::Warp(points, smooth_mm);
}

}  // namespace

StereoFit CorrectDepthByStereo(const fsm::Image& front_photo, const fsm::Image& side_photo,
                               CameraPose side_pose, FaceFit fit) {
  for (int round = 0; round < kStereoRounds; ++round) {
    const StereoMatcher matcher(fit.head, front_photo, side_photo);
    const auto refined = matcher.RefinePose(side_pose);
    if (!refined) break;
    side_pose = *refined;
    auto measured = matcher.MeasureDepth(side_pose);
    if (!measured) break;
    auto depths = OnBothCheeks(std::move(*measured), side_pose.TowardsCamera());
    const fsm::Warp rough = DepthWarp(depths, kRoughSmoothMm);
    std::erase_if(depths, [&](const PatchDepth& patch) {
      return std::abs(rough.Motion(patch.at_rest).z - patch.nearer_mm) > kMistakenMm;
    });
    if (depths.size() < kMinDepths) break;
    const fsm::Warp depth = DepthWarp(depths, kDepthSmoothMm);
    const std::vector<glm::vec3>& rest = fit.head.base->rest().position;
    fit = WithDepthShifted(std::move(fit), [&](const PixelConstraint& constraint) {
      return std::clamp(depth.Motion(constraint.on_head.On(rest)).z, -kMaxDepthStepMm,
                        kMaxDepthStepMm);
    });
  }
  return {std::move(fit), side_pose};
}

}  // namespace facefit
