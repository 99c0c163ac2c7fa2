#include "face_fit/fit/constraints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/find/face/mouth_line.h"
#include "face_fit/picture/plane.h"
#include "fsm/base/number_table.h"

namespace facefit {
namespace {

/// Distance from a corner of the mouth, divided by the mouth's width: beyond the first the outer
/// lips do not follow the corner, below the second they follow it wholly.
constexpr glm::vec2 kGoesWithCorner{0.3F, 0.05F};

/// Returns FitProblem::depth_bias.
std::vector<float> DepthBias(const ObservedHead& base) {
  std::vector<float> bias;
  float mean = 0;
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    bias.push_back(base.AtRest(i).z - base.DetectedDepthMm(i));
    mean += bias.back() / static_cast<float>(kNetworkPoints);
  }
  for (float& b : bias) b -= mean;
  return bias;
}

/// Returns constraints to where the network sees the points of the face. `posed`: as for
/// ConstrainToMouthLine.
std::vector<LandmarkConstraint> PointConstraints(const FitProblem& problem, const CameraPose& pose,
                                                 std::span<const glm::vec3> posed) {
  constexpr float kTrustDepth = 0.3F, kMaxDepthGapMm = 15;
  const std::vector<float> gaps_mm = DepthGapsMm(problem, pose, posed);
  std::vector<LandmarkConstraint> constraints;
  for (const PointIndex k : point::kReliable) {
    const MeshPoint& on_head = problem.base.mesh_points()[k];
    const float gap_mm = std::clamp(gaps_mm[constraints.size()], -kMaxDepthGapMm, kMaxDepthGapMm);
    constraints.push_back({k, on_head, problem.face.PixelOf(k),
                           pose.ToCamera(on_head.On(posed)).z + kTrustDepth * gap_mm});
  }
  return constraints;
}

/// Moves the outlines of eyes up or down where the irises show that the network misplaced them.
void ShiftLidsToIrises(const ObservedHead& base, const PhotoIrises& irises,
                       std::vector<LandmarkConstraint>& constraints) {
  for (const fsm::Side side : fsm::kSides) {
    const LidSpan lids = LidSpanOf(side, [&constraints](PointIndex i) {
      return std::ranges::find_if(constraints, [i](const auto& c) { return c.point == i; })->pixel;
    });
    const glm::vec2 shift_px = LidShiftPx(base, lids, irises.circles[side], side);
    for (LandmarkConstraint& constraint : constraints) {
      if (constraint.IsAmong(point::kEyeOutline[side])) constraint.pixel += shift_px;
    }
  }
}

std::uint32_t NearestLip(const ObservedHead& base, glm::vec3 p) {
  std::uint32_t nearest = 0;
  float distance = 1e9F;
  const auto& topology = base.head().topology();
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kLip) continue;
    for (const std::uint32_t v : topology.Corners(part)) {
      const float other = glm::distance(base.rest().position[v], p);
      if (other >= distance) continue;
      distance = other;
      nearest = v;
    }
  }
  return nearest;
}

/// Constrains closed lips to the line along which they meet in the photo, and moves the outer lips
/// beside a corner with it. `posed`: the base head's vertices in the
/// photo's expression.
void ConstrainToMouthLine(const FitProblem& problem, const CameraPose& pose,
                          std::span<const glm::vec3> posed, const fsm::Image& photo,
                          std::vector<LandmarkConstraint>& constraints) {
  const ObservedHead& base = problem.base;
  const glm::vec3 right = base.head().Landmark("cheilion_right");
  const glm::vec3 left = base.head().Landmark("cheilion_left");
  const auto along = [&](const MeshPoint& p) {
    return (p.On(base.rest().position).x - right.x) / (left.x - right.x);
  };
  const auto line =
      FindMouthLine(photo, problem.face, along(base.mesh_points()[point::kMouthRight]),
                    along(base.mesh_points()[point::kMouthLeft]));
  const auto on_line = [&](float along_mouth) {
    const float step = glm::clamp(along_mouth, 0.0F, 1.0F) * (kMouthLinePoints - 1);
    const auto k = std::min(static_cast<std::size_t>(step), kMouthLinePoints - 2);
    return glm::mix(line[k], line[k + 1], step - static_cast<float>(k));
  };
  // Where the network misplaces a corner it misplaces the outer lips beside it, too.
  for (const PointIndex corner : {point::kMouthRight, point::kMouthLeft}) {
    const float corner_along = along(base.mesh_points()[corner]);
    const glm::vec2 shift_px = on_line(corner_along) - problem.face.PixelOf(corner);
    for (LandmarkConstraint& constraint : constraints) {
      const bool outer_lip =
          constraint.IsAmong(point::kUpperOuterLip) || constraint.IsAmong(point::kLowerOuterLip);
      if (constraint.point != corner && !outer_lip) continue;
      constraint.pixel +=
          shift_px *
          fsm::SmoothStep(kGoesWithCorner, std::abs(along(constraint.on_head) - corner_along));
    }
  }
  const auto constrain = [&](const MeshPoint& p) {
    constraints.push_back({std::nullopt, p, on_line(along(p)), pose.ToCamera(p.On(posed)).z});
  };
  const std::span upper(point::kUpperInnerLip);
  for (const PointIndex i : upper.subspan(1, upper.size() - 2)) constrain(base.mesh_points()[i]);
  for (const glm::vec3 corner : {right, left}) {
    const std::uint32_t v = NearestLip(base, corner);
    constrain({{v, v, v}, {1, 0, 0}});
  }
}

}  // namespace

FitProblem::FitProblem(const ObservedHead& base_head, const FoundFace& found_face)
    : base(base_head),
      face(found_face),
      depth_bias(DepthBias(base_head)),
      lips_apart(LipsApart(found_face)) {}

std::vector<float> DepthGapsMm(const FitProblem& problem, const CameraPose& pose,
                               std::span<const glm::vec3> posed) {
  const float mm_per_pixel = 1 / pose.PixelsPerMm();
  std::vector<float> gaps;
  float mean = 0;
  for (const PointIndex k : point::kReliable) {
    const float own = pose.ToCamera(problem.base.mesh_points()[k].On(posed)).z;
    gaps.push_back(problem.face.points[k].z * mm_per_pixel + problem.depth_bias[k] - own);
    mean += gaps.back() / static_cast<float>(std::size(point::kReliable));
  }
  for (float& gap : gaps) gap -= mean;
  return gaps;
}

std::vector<LandmarkConstraint> ConstraintsOf(const FitProblem& problem, const CameraPose& pose,
                                              const Expression& expression,
                                              const PhotoIrises& irises, const fsm::Image* photo) {
  fsm::HeadVertices posed;
  problem.base.head().Evaluate(expression.State(), posed);
  auto constraints = PointConstraints(problem, pose, posed.position);
  ShiftLidsToIrises(problem.base, irises, constraints);
  const bool to_line = photo && !problem.lips_apart;
  if (to_line || problem.lips_apart) {
    std::erase_if(constraints, [](const auto& c) { return c.point && OnInnerLips(*c.point); });
  }
  if (to_line) ConstrainToMouthLine(problem, pose, posed.position, *photo, constraints);
  return constraints;
}

}  // namespace facefit
