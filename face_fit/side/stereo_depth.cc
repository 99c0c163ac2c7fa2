#include "face_fit/side/stereo_depth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "face_fit/side/stereo.h"

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
std::vector<fsm::WarpPoint> OnBothCheeks(std::vector<fsm::WarpPoint> depths, glm::vec3 towards) {
  const std::size_t count = depths.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [position, depth] = depths[i];
    if (position.x * towards.x > 0 && std::abs(position.x) > kMiddleMm) {
      depths.push_back({position * glm::vec3(-1, 1, 1), depth});
    }
  }
  return depths;
}

}  // namespace

StereoFit CorrectDepthByStereo(const fsm::Image& front_photo, const fsm::Image& side_photo,
                               CameraPose side_pose, FaceFit fit) {
  for (int round = 0; round < kStereoRounds; ++round) {
    const StereoMatcher matcher(fit.head, front_photo, side_photo);
    const auto refined = matcher.RefinePose(side_pose);
    if (!refined) break;
    side_pose = *refined;
    auto depths = OnBothCheeks(matcher.MeasureDepth(side_pose), side_pose.TowardsCamera());
    if (depths.empty()) break;
    const fsm::Warp rough(depths, kRoughSmoothMm);
    std::erase_if(depths, [&](const fsm::WarpPoint& measured) {
      return std::abs(rough.Motion(measured.position).z - measured.displacement.z) > kMistakenMm;
    });
    if (depths.size() < kMinDepths) break;
    const fsm::Warp depth(depths, kDepthSmoothMm);
    const std::vector<glm::vec3>& rest = fit.head.base->rest().position;
    fit = WithDepthShifted(std::move(fit), [&](const PixelConstraint& constraint) {
      return std::clamp(depth.Motion(constraint.on_head.On(rest)).z, -kMaxDepthStepMm,
                        kMaxDepthStepMm);
    });
  }
  return {std::move(fit), side_pose};
}

}  // namespace facefit
