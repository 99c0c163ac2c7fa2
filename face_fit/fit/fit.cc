#include "face_fit/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/fit/pixel_warp.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/image/plane.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Unknowns of the fit: the pose's, then the strengths of Expression.
enum FitParameter : std::size_t { kSmile = kPoseParameters, kJawDrop, kLipsPart, kFitParameters };
constexpr double kMaxStrength = 1.5;
using Parameters = std::vector<double>;

Expression ExpressionFrom(const Parameters& p) {
  const auto strength = [&p](FitParameter i) {
    return static_cast<float>(std::clamp(p[i], 0.0, kMaxStrength));
  };
  return {
      .smile = strength(kSmile), .jaw_drop = strength(kJawDrop), .lips_part = strength(kLipsPart)};
}

std::vector<double> ResidualsOf(const FitProblem& problem, const Parameters& parameters) {
  const CameraPose pose = PoseFromParameters(parameters);
  const std::vector<glm::vec3> base_in_expression =
      problem.base.InState(ExpressionFrom(parameters).State());
  const float mm_per_pixel = 1 / pose.PixelsPerMm();
  std::vector<double> out;
  for (const PointIndex k : point::kReliable) {
    const glm::vec2 pixel = pose.PixelOf(problem.base.mesh_points()[k].On(base_in_expression));
    const glm::vec2 offset = (pixel - problem.face.PixelOf(k)) * mm_per_pixel;
    out.push_back(static_cast<double>(offset.x));
    out.push_back(static_cast<double>(offset.y));
  }
  // The network's depth is less reliable than its x and y.
  constexpr double kDepthWeight = 0.4;
  for (const float gap_mm : NetworkDepthGapsMm(problem, pose, base_in_expression)) {
    out.push_back(kDepthWeight * static_cast<double>(gap_mm));
  }
  // Priors, as the residual in millimetres of a unit at full strength: people mostly hold still for
  // a photo. Without visible teeth the form of a mouth is taken for the person's own rather than
  // for a smile, and a dropped jaw or parted lips are ruled out.
  constexpr double kApartMm = 6, kClosedSmileMm = 40, kRuledOutMm = 1e4;
  out.push_back((problem.lips_apart ? kApartMm : kClosedSmileMm) * parameters[kSmile]);
  for (const FitParameter i : {kJawDrop, kLipsPart}) {
    out.push_back((problem.lips_apart ? kApartMm : kRuledOutMm) * parameters[i]);
  }
  return out;
}

Parameters FitPoseAndExpression(const FitProblem& problem, const CameraPose& start) {
  std::vector<Unknown> unknowns = PoseUnknowns(start);
  for (std::size_t i = kSmile; i < kFitParameters; ++i) {
    unknowns.push_back({.start = 0, .step = 0.05, .low = 0, .high = kMaxStrength});
  }
  return LevenbergMarquardt([&problem](const Parameters& p) { return ResidualsOf(problem, p); },
                            unknowns, kPoseRounds);
}

/// Computes size, position and tilt from the outer corners of the eyes and the root of the nose.
CameraPose InitialPose(const ObservedHead& base, const FoundFace& face) {
  using namespace point;
  const glm::vec2 eyes = face.AcrossEyes();
  const float width_mm = glm::distance(base.AtRest(kEyeOuterRight), base.AtRest(kEyeOuterLeft));
  const float pixels_per_mm = glm::length(eyes) / width_mm;
  const glm::vec3 root = base.AtRest(kNoseBridge);
  return {.rotation_rad = {0, 0, -AngleOf(eyes)},
          .focal_px = pixels_per_mm * (kCameraDepthMm - kFaceDepthMm),
          .centre_px = face.PixelOf(kNoseBridge) + pixels_per_mm * glm::vec2(-root.x, root.y)};
}

/// Returns the strength of a smile without what mouths at rest have: they differ from the
/// built-in one as if they smiled. Of a closed mouth that is always subtracted, since removing
/// it would leave a grim face. Parted lips show teeth, so more than a little is a smile as a whole.
float SmileBeyondRest(float smile, bool lips_apart) {
  const auto& resting = PhotoLook().resting_smile;
  if (lips_apart) return smile < resting.lips_apart ? 0 : smile;
  return std::max(smile - resting.lips_closed, 0.0F);
}

}  // namespace

FaceFit FitFace(const ObservedHead& base, const FoundFace& face, const fsm::Image& photo) {
  const FitProblem problem(base, face);
  const Parameters settled = FitPoseAndExpression(problem, InitialPose(base, face));
  const CameraPose pose = PoseFromParameters(settled);
  Expression expression = ExpressionFrom(settled);
  expression.smile = SmileBeyondRest(expression.smile, problem.lips_apart);
  const PhotoIrises irises = FindPhotoIrises(base, face, photo);
  std::vector<glm::vec3> base_in_expression = base.InState(expression.State());
  auto constraints = MakeConstraints(problem, pose, base_in_expression, irises, photo);
  FittedHead head =
      WarpToPixels(base, pose, expression, std::move(base_in_expression), constraints);
  return {std::move(head), std::move(constraints), irises};
}

float ResidualMm(const FoundFace& face, const FittedHead& fitted) {
  float sum = 0;
  for (const PointIndex k : point::kReliable) {
    sum += glm::distance(fitted.pose.PixelOf(fitted.PositionOf(k)), face.PixelOf(k));
  }
  return sum / fitted.pose.PixelsPerMm() / static_cast<float>(std::size(point::kReliable));
}

FaceFit WithDepthShifted(FaceFit fit,
                         const std::function<float(const PixelConstraint&)>& nearer_mm) {
  for (PixelConstraint& constraint : fit.constraints) constraint.z_mm += nearer_mm(constraint);
  FittedHead& head = fit.head;
  head = WarpToPixels(*head.base, head.pose, head.expression, std::move(head.base_in_expression),
                      fit.constraints);
  return fit;
}

}  // namespace facefit
