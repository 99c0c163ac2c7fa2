#include "face_fit/fit/constraints.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/find/face/photo_lip_seam.h"
#include "face_fit/image/plane.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns FitProblem::depth_bias.
PerPoint<float> DepthBias(const ObservedHead& base) {
  PerPoint<float> bias;
  float mean = 0;
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    bias[i] = base.AtRest(i).z - base.DetectedDepthMm(i);
    mean += bias[i] / static_cast<float>(kNetworkPoints);
  }
  for (float& b : bias) b -= mean;
  return bias;
}

/// Returns constraints to where the network sees the points of the face, inner lips left out.
/// `base_in_expression`: as FittedHead's.
std::vector<PixelConstraint> PointConstraints(const FitProblem& problem, const CameraPose& pose,
                                              std::span<const glm::vec3> base_in_expression) {
  constexpr float kTrustDepth = 0.3F, kMaxDepthGapMm = 15;
  const std::vector<float> gaps_mm = NetworkDepthGapsMm(problem, pose, base_in_expression);
  std::vector<PixelConstraint> constraints;
  for (std::size_t i = 0; i < gaps_mm.size(); ++i) {
    const PointIndex k = point::kReliable[i];
    if (OnInnerLips(k)) continue;
    const MeshPoint& on_head = problem.base.mesh_points()[k];
    const float gap_mm = std::clamp(gaps_mm[i], -kMaxDepthGapMm, kMaxDepthGapMm);
    constraints.push_back({k, on_head, problem.face.PixelOf(k),
                           pose.ToCamera(on_head.On(base_in_expression)).z + kTrustDepth * gap_mm});
  }
  return constraints;
}

/// Moves the outlines of eyes up or down where the irises show that the network misplaced them.
void ShiftLidsToIrises(const PhotoIrises& irises, std::vector<PixelConstraint>& constraints) {
  for (const fsm::Side side : fsm::kSides) {
    const glm::vec2 shift_px = LidShiftPx(irises.eyes[side]);
    for (PixelConstraint& constraint : constraints) {
      if (constraint.IsAmong(point::kEyeOutline[side])) constraint.pixel += shift_px;
    }
  }
}

std::uint32_t NearestLip(const ObservedHead& base, glm::vec3 p) {
  std::uint32_t nearest = 0;
  float distance = 1e9F;
  const auto& surface = base.surface();
  for (const auto& part : surface.parts) {
    if (part.material != fsm::Material::kLip) continue;
    for (const std::uint32_t v : surface.Corners(part)) {
      const float other = glm::distance(base.rest().position[v], p);
      if (other >= distance) continue;
      distance = other;
      nearest = v;
    }
  }
  return nearest;
}

/// Returns the position along the mouth of the base head at rest, as for PhotoLipSeam.
float AlongMouth(const ObservedHead& base, const MeshPoint& p) {
  const float right = base.head().Landmark("cheilion_right").x,
              left = base.head().Landmark("cheilion_left").x;
  return (p.On(base.rest().position).x - right) / (left - right);
}

/// Moves the corners of the mouth onto the lip seam, and the outer lips beside them with them:
/// where the network misplaces a corner it misplaces these, too.
void ShiftOuterLips(const FitProblem& problem, const PhotoLipSeam& seam,
                    std::vector<PixelConstraint>& constraints) {
  for (const PointIndex corner : point::kMouthCorners) {
    const float corner_along = AlongMouth(problem.base, problem.base.mesh_points()[corner]);
    const glm::vec2 shift_px = seam.PixelAt(corner_along) - problem.face.PixelOf(corner);
    for (PixelConstraint& constraint : constraints) {
      const bool outer_lip =
          constraint.IsAmong(point::kUpperOuterLip) || constraint.IsAmong(point::kLowerOuterLip);
      if (constraint.point != corner && !outer_lip) continue;
      constraint.pixel +=
          shift_px * PhotoLook().outer_lips.go_with_corner.Ramp(
                         std::abs(AlongMouth(problem.base, constraint.on_head) - corner_along));
    }
  }
}

/// Constrains closed lips to the lip seam. `base_in_expression`: as FittedHead's.
void ConstrainToLipSeam(const FitProblem& problem, const CameraPose& pose,
                        std::span<const glm::vec3> base_in_expression, const PhotoLipSeam& seam,
                        std::vector<PixelConstraint>& constraints) {
  const ObservedHead& base = problem.base;
  const auto constrain = [&](const MeshPoint& p) {
    constraints.push_back({std::nullopt, p, seam.PixelAt(AlongMouth(base, p)),
                           pose.ToCamera(p.On(base_in_expression)).z});
  };
  for (const PointIndex i : point::kUpperInnerLip) constrain(base.mesh_points()[i]);
  for (const char* corner : {"cheilion_right", "cheilion_left"}) {
    const std::uint32_t v = NearestLip(base, base.head().Landmark(corner));
    constrain({{v, v, v}, {1, 0, 0}});
  }
}

}  // namespace

FitProblem::FitProblem(const ObservedHead& base_head, const FoundFace& found_face)
    : base(base_head),
      face(found_face),
      depth_bias(DepthBias(base_head)),
      lips_apart(LipsApart(found_face)) {}

std::vector<float> NetworkDepthGapsMm(const FitProblem& problem, const CameraPose& pose,
                                      std::span<const glm::vec3> base_in_expression) {
  const float mm_per_pixel = 1 / pose.PixelsPerMm();
  std::vector<float> gaps;
  float mean = 0;
  for (const PointIndex k : point::kReliable) {
    const float base_z = pose.ToCamera(problem.base.mesh_points()[k].On(base_in_expression)).z;
    gaps.push_back(problem.face.points[k].z * mm_per_pixel + problem.depth_bias[k] - base_z);
    mean += gaps.back() / static_cast<float>(std::size(point::kReliable));
  }
  for (float& gap : gaps) gap -= mean;
  return gaps;
}

std::vector<PixelConstraint> MakeConstraints(const FitProblem& problem, const CameraPose& pose,
                                             std::span<const glm::vec3> base_in_expression,
                                             const PhotoIrises& irises, const fsm::Image& photo) {
  auto constraints = PointConstraints(problem, pose, base_in_expression);
  ShiftLidsToIrises(irises, constraints);
  if (problem.lips_apart) return constraints;
  const auto along = [&problem](PointIndex corner) {
    return AlongMouth(problem.base, problem.base.mesh_points()[corner]);
  };
  const PhotoLipSeam seam =
      TraceLipSeam(photo, problem.face, {along(point::kMouthRight), along(point::kMouthLeft)});
  ShiftOuterLips(problem, seam, constraints);
  ConstrainToLipSeam(problem, pose, base_in_expression, seam, constraints);
  return constraints;
}

}  // namespace facefit
