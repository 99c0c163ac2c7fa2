#include "face_fit/fit/photo_targets.h"

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

/// Distance of an iris above or below the middle between the lids that counts as normal, since eyes
/// rest differently; and the most by which lids are moved.
constexpr float kFreeRestMm = 0.5F, kMaxShiftMm = 3;

/// Plausible limits of an iris, relative to the built-in one.
constexpr glm::vec2 kIrisSize{0.8F, 1.12F};
/// Distance from a corner of the mouth, divided by the mouth's width: beyond the first the outer
/// lips do not follow the corner, below the second they follow it wholly.
constexpr glm::vec2 kGoesWithCorner{0.3F, 0.05F};

/// Returns FitProblem::depth_bias.
std::vector<float> DepthBias(const ObservedHead& base) {
  std::vector<float> bias;
  float mean = 0;
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    bias.push_back(base.AtRest(i).z - base.detected()[i].z);
    mean += bias.back() / static_cast<float>(kNetworkPoints);
  }
  for (float& b : bias) b -= mean;
  return bias;
}

/// Returns constraints to where the network sees the points of the face. `posed`: as for
/// ConstrainToMouthLine.
std::vector<LandmarkConstraint> ConstraintsOf(const FitProblem& problem, const CameraPose& pose,
                                              const std::vector<glm::vec3>& posed) {
  constexpr float kTrustDepth = 0.3F, kMaxDepthGapMm = 15;
  const float mm_per_pixel = 1 / pose.PixelsPerMm();
  std::vector<LandmarkConstraint> constraints;
  std::vector<float> depth_gaps;
  float mean = 0;
  for (const PointIndex k : point::kForFit) {
    const glm::vec3 q = pose.ToCamera(problem.base.places()[k].On(posed));
    depth_gaps.push_back(problem.face.points[k].z * mm_per_pixel + problem.depth_bias[k] - q.z);
    mean += depth_gaps.back() / static_cast<float>(std::size(point::kForFit));
    constraints.push_back({k, problem.base.places()[k], problem.face.PixelOf(k), q.z});
  }
  for (std::size_t i = 0; i < depth_gaps.size(); ++i) {
    constraints[i].z_mm +=
        kTrustDepth * std::clamp(depth_gaps[i] - mean, -kMaxDepthGapMm, kMaxDepthGapMm);
  }
  return constraints;
}

/// An eye's outline in the photo: corners and the middle between the lids.
struct LidSpan {
  glm::vec2 outer, inner, middle;
};
template <typename Place>
LidSpan LidSpanOf(fsm::Side side, Place place) {
  const auto outline = EyeOutline(side);
  return {place(outline[kOuterCorner]), place(outline[kInnerCorner]),
          0.5F * (place(outline[kUpperMiddle]) + place(outline[kLowerMiddle]))};
}
/// Where the iris is expected; the scale is relative to the base head's eye.
struct IrisPlacement {
  glm::vec2 centre;
  float pixels_per_mm;
};
IrisPlacement ExpectedIris(const ObservedHead& base, const LidSpan& photo, fsm::Side side) {
  const LidSpan own = LidSpanOf(
      side, [&base](PointIndex i) { return glm::vec2(1, -1) * glm::vec2(base.AtRest(i)); });
  const glm::vec3 ball = base.head().topology().eyes[side].centre;
  const glm::vec2 from = own.inner - own.outer, to = photo.inner - photo.outer;
  const float pixels_per_mm = glm::length(to) / std::max(glm::length(from), 1e-3F);
  const float turn_rad = std::atan2(to.y, to.x) - std::atan2(from.y, from.x);
  const glm::vec2 from_middle = glm::vec2(ball.x, -ball.y) - own.middle;
  return {photo.middle + pixels_per_mm * Rotated(from_middle, turn_rad), pixels_per_mm};
}

/// Moves the outlines of eyes up or down where the irises show that the network misplaced them.
void ShiftLidsToIrises(const ObservedHead& base, const PhotoIrises& irises,
                       std::vector<LandmarkConstraint>& constraints) {
  for (const fsm::Side side : fsm::kSides) {
    const IrisCircle& iris = irises.circles[side];
    if (iris.contrast <= 0) continue;
    const LidSpan span = LidSpanOf(side, [&constraints](PointIndex i) {
      return std::ranges::find_if(constraints, [i](const auto& c) { return c.point == i; })->pixel;
    });
    const IrisPlacement expected = ExpectedIris(base, span, side);
    const glm::vec2 axis = glm::normalize(span.inner - span.outer);
    const glm::vec2 across(-axis.y, axis.x);
    const float free_px = kFreeRestMm * expected.pixels_per_mm;
    const float max_px = kMaxShiftMm * expected.pixels_per_mm;
    const float shift_px =
        std::clamp(glm::dot(iris.centre - expected.centre, across), -max_px, max_px);
    if (std::abs(shift_px) <= free_px) continue;
    for (LandmarkConstraint& constraint : constraints) {
      if (!constraint.IsAmong(EyeOutline(side))) continue;
      constraint.pixel += (shift_px - std::copysign(free_px, shift_px)) * across;
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

/// Replaces the constraints of closed inner lips by the line along which they meet in the photo,
/// and moves the outer lips beside a corner with it. `posed`: the base head's vertices in the
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
  const auto line = FindMouthLine(photo, problem.face, along(base.places()[point::kMouthRight]),
                                  along(base.places()[point::kMouthLeft]));
  std::erase_if(constraints, [](const auto& c) {
    return c.IsAmong(point::kUpperInnerLip) || c.IsAmong(point::kLowerInnerLip);
  });
  const auto on_line = [&](float part) {
    const float step = glm::clamp(part, 0.0F, 1.0F) * (kMouthLinePoints - 1);
    const auto k = std::min(static_cast<std::size_t>(step), kMouthLinePoints - 2);
    return glm::mix(line[k], line[k + 1], step - static_cast<float>(k));
  };
  // Where the network misplaces a corner it misplaces the outer lips beside it, too.
  for (const PointIndex corner : {point::kMouthRight, point::kMouthLeft}) {
    const float corner_part = along(base.places()[corner]);
    const glm::vec2 shift_px = on_line(corner_part) - problem.face.PixelOf(corner);
    for (LandmarkConstraint& constraint : constraints) {
      const bool outer_lip =
          constraint.IsAmong(point::kUpperOuterLip) || constraint.IsAmong(point::kLowerOuterLip);
      if (constraint.point != corner && !outer_lip) continue;
      constraint.pixel +=
          shift_px *
          fsm::SmoothStep(kGoesWithCorner, std::abs(along(constraint.on_head) - corner_part));
    }
  }
  const auto constrain = [&](const MeshPoint& p) {
    constraints.push_back({std::nullopt, p, on_line(along(p)), pose.ToCamera(p.On(posed)).z});
  };
  const std::span upper(point::kUpperInnerLip);
  for (const PointIndex i : upper.subspan(1, upper.size() - 2)) constrain(base.places()[i]);
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

PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image* photo) {
  PhotoIrises irises;
  fsm::Sided<OpenEye> eyes;
  for (const fsm::Side side : fsm::kSides) {
    const auto place = [&face](PointIndex i) { return face.PixelOf(i); };
    const IrisPlacement iris = ExpectedIris(base, LidSpanOf(side, place), side);
    std::ranges::transform(EyeOutline(side), eyes[side].lids.begin(), place);
    eyes[side].middle = iris.centre;
    eyes[side].expected_radius = iris.pixels_per_mm * base.head().topology().eyes[side].iris_radius;
    irises.circles[side] = {
        .centre = iris.centre, .radius = eyes[side].expected_radius, .contrast = 0};
  }
  if (!photo) return irises;
  const auto found = FindIrises(*photo, std::array{eyes.right, eyes.left});
  float size = 0, count = 0;
  for (const fsm::Side side : fsm::kSides) {
    const IrisCircle& iris = found[static_cast<std::size_t>(side)];
    if (iris.contrast < kClearIris) continue;
    irises.circles[side] = iris;
    size += iris.radius / eyes[side].expected_radius;
    count += 1;
  }
  if (count > 0) irises.size = std::clamp(size / count, kIrisSize.x, kIrisSize.y);
  return irises;
}

PhotoTargets TargetsOf(const FitProblem& problem, const CameraPose& pose,
                       const Expression& expression, const PhotoIrises& irises,
                       const fsm::Image* photo) {
  fsm::HeadVertices posed;
  problem.base.head().Evaluate(expression.State(), posed);
  PhotoTargets targets{ConstraintsOf(problem, pose, posed.position), problem.lips_apart};
  ShiftLidsToIrises(problem.base, irises, targets.constraints);
  if (photo && !problem.lips_apart) {
    ConstrainToMouthLine(problem, pose, posed.position, *photo, targets.constraints);
  }
  return targets;
}

}  // namespace facefit
