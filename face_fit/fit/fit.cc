#include "face_fit/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/find/face/mouth_line.h"
#include "face_fit/fit/eye_fit.h"
#include "face_fit/fit/landmark_warp.h"
#include "face_fit/fit/least_squares.h"
#include "face_fit/fit/pose_fit.h"

namespace facefit {
namespace {

/// Unknowns of the fit: those of the pose, and the strengths of Expression.
enum FitParameter : std::size_t { kSmile = kPoseParameters, kJaw, kParted, kFitParameters };
constexpr double kMostExpression = 1.5;
constexpr int kRounds = 20;
using Parameters = std::vector<double>;

Expression ExpressionOf(const Parameters& p) {
  const auto strength = [&p](FitParameter i) {
    return static_cast<float>(std::clamp(p[i], 0.0, kMostExpression));
  };
  return {.smile = strength(kSmile), .jaw = strength(kJaw), .parted = strength(kParted)};
}

struct Sight {
  const BaseHead& base;
  const FoundFace& face;
  std::vector<float> depth_bias;  ///< true minus seen, of the base head, mean removed
  bool lips_apart;
};

std::vector<double> ResidualsOf(const Sight& sight, const Parameters& parameters) {
  const CameraPose pose = PoseOf(parameters);
  fsm::HeadVertices vertices;
  sight.base.head->Evaluate(ExpressionOf(parameters).State(), vertices);
  const float mm_per_pixel = 1 / pose.PixelsPerMm();
  std::vector<double> out;
  std::vector<float> depth;
  float mean = 0;
  for (const PointIndex k : PointsForFit()) {
    const glm::vec3 q = pose.ToCamera(sight.base.points[k].On(vertices.position));
    const glm::vec2 miss = (pose.Project(q) - sight.face.At(k)) * mm_per_pixel;
    out.push_back(static_cast<double>(miss.x));
    out.push_back(static_cast<double>(miss.y));
    depth.push_back(q.z - sight.face.points[k].z * mm_per_pixel - sight.depth_bias[k]);
    mean += depth.back();
  }
  mean /= static_cast<float>(depth.size());
  // The network is less sure of depth than of place.
  constexpr double kDepthWeight = 0.4;
  for (const float d : depth) out.push_back(kDepthWeight * static_cast<double>(d - mean));
  // People mostly hold still for a photo: what is not clearly seen is not assumed. Without teeth to
  // see a mouth's form is taken for the person's own rather than for a smile. Millimetres that a
  // unit at full strength counts as.
  constexpr double kApartMm = 6, kClosedSmileMm = 40, kClosedJawMm = 1e4;
  out.push_back((sight.lips_apart ? kApartMm : kClosedSmileMm) * parameters[kSmile]);
  for (const FitParameter i : {kJaw, kParted}) {
    out.push_back((sight.lips_apart ? kApartMm : kClosedJawMm) * parameters[i]);
  }
  return out;
}

Parameters Refine(const Sight& sight, const Parameters& start) {
  std::vector<Unknown> unknowns;
  for (std::size_t i = kTurnX; i <= kLogFocal; ++i) {
    unknowns.push_back({.start = start[i], .step = 1e-3});
  }
  for (const std::size_t i : {kCentreX, kCentreY}) {
    unknowns.push_back({.start = start[i], .step = 0.5});
  }
  for (std::size_t i = kSmile; i < kFitParameters; ++i) {
    unknowns.push_back({.start = start[i], .step = 0.05, .low = 0, .high = kMostExpression});
  }
  return LevenbergMarquardt([&sight](const Parameters& p) { return ResidualsOf(sight, p); },
                            unknowns, kRounds);
}

/// What the network sees of depth too much or too little on the base head; mean 0, millimetres.
std::vector<float> DepthBias(const BaseHead& base) {
  std::vector<float> bias;
  float mean = 0;
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    bias.push_back(base.AtRest(i).z - base.seen_z[i]);
    mean += bias.back() / static_cast<float>(kNetworkPoints);
  }
  for (float& b : bias) b -= mean;
  return bias;
}

/// Size, position and tilt by the outer corners of the eyes and the root of the nose.
Parameters FirstGuess(const BaseHead& base, const FoundFace& face) {
  using namespace point;
  const glm::vec2 right = face.At(kEyeOuterRight), left = face.At(kEyeOuterLeft),
                  nose = face.At(kNoseBridge);
  const float wide = glm::distance(base.AtRest(kEyeOuterRight), base.AtRest(kEyeOuterLeft));
  const float scale = glm::distance(right, left) / wide;
  const glm::vec3 root = base.AtRest(kNoseBridge);
  Parameters start(kFitParameters);
  start[kTurnZ] = -std::atan2(left.y - right.y, left.x - right.x);
  start[kLogFocal] = std::log(static_cast<double>(scale * (kCameraZ - kFaceZ)));
  start[kCentreX] = nose.x - scale * root.x;
  start[kCentreY] = nose.y + scale * root.y;
  return start;
}

/// How mouths at rest differ from the built-in one looks like that much of a smile; taken away from
/// a closed mouth it would leave a grim face.
float SmileBeyondUsual(float smile, bool lips_apart) {
  constexpr float kUsualApart = 0.12F, kUsualClosed = 0.45F;
  if (lips_apart) return smile < kUsualApart ? 0 : smile;
  return std::max(smile - kUsualClosed, 0.0F);
}

/// Where the network sees the points of the face, their depth mostly as the head's own form has it.
std::vector<LandmarkConstraint> ConstraintsOf(const Sight& sight, const CameraPose& pose,
                                              const std::vector<glm::vec3>& now) {
  constexpr float kTrustDepth = 0.3F, kMostDepth = 15;  // millimetres
  const float mm_per_pixel = 1 / pose.PixelsPerMm();
  std::vector<LandmarkConstraint> constraints;
  std::vector<float> lacks;
  float mean = 0;
  for (const PointIndex k : PointsForFit()) {
    const glm::vec3 q = pose.ToCamera(sight.base.points[k].On(now));
    lacks.push_back(sight.face.points[k].z * mm_per_pixel + sight.depth_bias[k] - q.z);
    mean += lacks.back() / static_cast<float>(PointsForFit().size());
    constraints.push_back({k, sight.base.points[k], sight.face.At(k), q.z});
  }
  for (std::size_t i = 0; i < lacks.size(); ++i) {
    constraints[i].z += kTrustDepth * std::clamp(lacks[i] - mean, -kMostDepth, kMostDepth);
  }
  return constraints;
}

/// Mean distance of the network's points from those of the fitted head, millimetres.
float ResidualMm(const BaseHead& base, const FoundFace& face, const FittedHead& fitted) {
  float sum = 0;
  for (const PointIndex k : PointsForFit()) {
    const glm::vec3 q = fitted.pose.ToCamera(base.points[k].On(fitted.posed_vertices));
    sum += glm::distance(fitted.pose.Project(q), face.At(k));
  }
  return sum / fitted.pose.PixelsPerMm() / static_cast<float>(PointsForFit().size());
}

}  // namespace

Fit FitFace(const BaseHead& base, const FoundFace& face, const fsm::Image* photo) {
  const Sight sight{base, face, DepthBias(base), LipsApart(face)};
  const Parameters settled = Refine(sight, FirstGuess(base, face));
  Fit fit;
  FittedHead& fitted = fit.head;
  fitted.pose = PoseOf(settled);
  fitted.expression = ExpressionOf(settled);
  fitted.expression.smile = SmileBeyondUsual(fitted.expression.smile, sight.lips_apart);
  fsm::HeadVertices now;
  base.head->Evaluate(fitted.expression.State(), now);
  fit.targets = {ConstraintsOf(sight, fitted.pose, now.position), sight.lips_apart};
  fit.irises = SeeIrises(base, face, photo);
  CentreEyes(base, fit.irises, fit.targets.constraints);
  if (photo && !sight.lips_apart) {
    ConstrainToMouthLine(base, face, fitted.pose, now.position, *photo, fit.targets.constraints);
  }
  WarpToLandmarks(base, fit.targets, fitted);
  fit.residual_mm = ResidualMm(base, face, fitted);
  return fit;
}

}  // namespace facefit
