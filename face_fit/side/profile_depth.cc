#include "face_fit/side/profile_depth.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "face_fit/fit/pose_fit.h"
#include "face_fit/side/profile_search.h"

namespace facefit {
namespace {

// Distance before and behind the profile in which the outline is searched.
constexpr float kReachMm = 13;
constexpr float kReachStepMm = 0.5F;
constexpr float kEvenMm = 2.2F;  // sigma of the Gaussian over height that smooths gaps
// Distance from the middle of the face at which 1/e of a gap is corrected.
constexpr float kWideMm = 24;
constexpr float kMaxCorrectionMm = 6;     // in one round
constexpr float kProfileBelowChinMm = 1;  // the profile ends there: the throat has no constraints
constexpr int kProfileRounds = 3, kOutlineRounds = 6;

/// Returns how far before a point of the profile the outline lies (negative: behind), millimetres
/// of depth; nothing beyond kReachMm.
std::optional<float> OutlineDepthGap(const Mask& opacity, const CameraPose& pose,
                                     glm::vec3 position) {
  const auto inside = [&](float depth) {
    const glm::vec2 pixel = pose.PixelOf(position + glm::vec3(0, 0, depth));
    return opacity.SampleAt(pixel.x, pixel.y) - 0.5F;
  };
  if (inside(kReachMm) > 0) return {};
  for (float depth = kReachMm - kReachStepMm; depth >= -kReachMm; depth -= kReachStepMm) {
    const float opaque = inside(depth);
    if (opaque <= 0) continue;
    const float beyond = inside(depth + kReachStepMm);
    return depth + kReachStepMm * opaque / std::max(opaque - beyond, 1e-6F);
  }
  return {};
}

float MeanOutlineDepthGap(const Mask& opacity, const CameraPose& pose,
                          const std::vector<glm::vec3>& line) {
  float sum = 0;
  for (const glm::vec3& p : line) {
    sum += std::abs(OutlineDepthGap(opacity, pose, p).value_or(kReachMm)) /
           static_cast<float>(line.size());
  }
  return sum;
}

/// Refines scale, position and lean of the profile by the outline found near it.
CameraPose FitPoseToOutline(const Mask& opacity, CameraPose pose,
                            const std::vector<glm::vec3>& line) {
  for (int round = 0; round < kOutlineRounds; ++round) {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> pixels;
    for (const glm::vec3& p : line) {
      const auto depth = OutlineDepthGap(opacity, pose, p);
      if (!depth) continue;
      positions.push_back(p);
      pixels.push_back(pose.PixelOf(p + glm::vec3(0, 0, *depth)));
    }
    if (positions.empty() || positions.size() < line.size() / 2) return pose;
    CameraPose best = pose;
    float best_gap = MeanOutlineDepthGap(opacity, pose, line);
    for (const float lean_deg : {-2.0F, -1.0F, -0.4F, 0.0F, 0.4F, 1.0F, 2.0F}) {
      const CameraPose next = PoseWithRotation(
          positions, pixels, pose.rotation_rad + glm::vec3(0, 0, glm::radians(lean_deg)));
      const float gap = MeanOutlineDepthGap(opacity, next, line);
      if (gap >= best_gap) continue;
      best_gap = gap;
      best = next;
    }
    pose = best;
  }
  return pose;
}

/// Returns the fit with its constraints moved forward or back by the gaps along the profile, which
/// are smoothed over height, less with distance from the middle of the face.
FaceFit WithoutGaps(const Mask& opacity, const CameraPose& pose, const std::vector<glm::vec3>& line,
                    FaceFit fit) {
  std::vector<std::pair<float, float>> gaps;  // height and gap, millimetres
  for (const glm::vec3& p : line) {
    if (const auto gap = OutlineDepthGap(opacity, pose, p)) gaps.emplace_back(p.y, *gap);
  }
  const auto gap_at = [&gaps](float height) {
    float sum = 0, weights = 1e-3F;
    for (const auto& [gap_height, gap] : gaps) {
      const float sigmas = (gap_height - height) / kEvenMm;
      const float weight = std::exp(-0.5F * sigmas * sigmas);
      sum += weight * gap;
      weights += weight;
    }
    return sum / weights;
  };
  const std::vector<glm::vec3> vertices = fit.head.vertices;
  return WithDepthShifted(std::move(fit), [&](const PixelConstraint& constraint) {
    const glm::vec3 p = constraint.on_head.On(vertices);
    const float weight = std::exp(-p.x * p.x / (kWideMm * kWideMm));
    return weight * std::clamp(gap_at(p.y), -kMaxCorrectionMm, kMaxCorrectionMm);
  });
}

/// Returns the pose that projects the profile to where it was found.
CameraPose PoseOfProfile(const ProfilePlacement& placement, const std::vector<glm::vec3>& line) {
  std::vector<glm::vec2> pixels;
  for (const glm::vec3& p : line) pixels.push_back(placement.PixelOf(p));
  return PoseWithRotation(
      line, pixels, {0, glm::radians(90.0F) * Outward(placement.towards), -placement.tilt_rad});
}

}  // namespace

std::optional<FaceFit> CorrectDepthByProfile(const Mask& opacity, FaceFit fit) {
  const auto placement = FindProfile(fit.head, opacity);
  if (!placement) return std::nullopt;
  std::vector<glm::vec3> line = ProfileOf(fit.head, kProfileBelowChinMm);
  CameraPose pose = FitPoseToOutline(opacity, PoseOfProfile(*placement, line), line);
  if (MeanOutlineDepthGap(opacity, pose, line) > kMaxProfileGapMm) return std::nullopt;
  fit = WithoutGaps(opacity, pose, line, std::move(fit));
  for (int round = 1; round < kProfileRounds; ++round) {
    line = ProfileOf(fit.head, kProfileBelowChinMm);
    pose = FitPoseToOutline(opacity, pose, line);
    fit = WithoutGaps(opacity, pose, line, std::move(fit));
  }
  return fit;
}

}  // namespace facefit
