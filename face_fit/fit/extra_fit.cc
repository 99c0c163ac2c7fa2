#include "face_fit/fit/extra_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "face_fit/find/head/portrait_view.h"
#include "face_fit/fit/landmark_warp.h"
#include "face_fit/fit/stereo.h"
#include "fsm/rig/normals.h"

namespace facefit {
namespace {

constexpr int kDrawnSize = 640;
/// Below it a photo tells no more of depth than the first one did; beyond it the network guesses.
constexpr float kLeastTurn = 12, kMostTurn = 80;  // degrees
/// Of a turned face the network is less sure than of one from the front (kCertainFace).
constexpr float kLeastCertainty = 0.5F;
/// Points of the same face drawn and seen lie nearer than that, those of another mostly do not.
constexpr float kMostResidual = 2.6F;  // millimetres

/// What can be compared: points of the network with the place of the posed head, and how far beside
/// it the network sees them (millimetres to the right and down, as the camera has it).
struct ComparedPoint {
  PointIndex point;
  glm::vec3 at;
  glm::vec2 bias{0};
  float weight = 1;
};

std::vector<ComparedPoint> ComparedPoints(const FittedHead& fitted) {
  std::vector<ComparedPoint> points;
  for (const PointIndex i : point::kForFit) {
    points.push_back({i, fitted.At(i)});
  }
  return points;
}

/// As matches of a pose: the bias is that of what is seen.
std::vector<PointMatch> MatchesOf(const std::vector<ComparedPoint>& points, const FoundFace& face,
                                  const CameraPose& pose) {
  std::vector<PointMatch> matches;
  for (const ComparedPoint& point : points) {
    const glm::vec2 seen = face.At(point.point);
    matches.push_back({point.at, seen - point.bias * pose.PixelsPerMm(), point.weight});
  }
  return matches;
}

/// Draws the posed head turned as in the pose, lets the network look at it, and notes in the points
/// how far beside their places it sees them, and which of them are turned away. False if it sees no
/// face.
bool MeasureBias(FaceNetworks& networks, const FittedHead& fitted, const CameraPose& pose,
                 std::vector<ComparedPoint>& points) {
  fsm::HeadVertices turned;
  for (const glm::vec3& p : fitted.posed_vertices) turned.position.push_back(pose.ToCamera(p));
  turned.normal =
      fsm::Normals(fitted.base->head->topology().indices, turned.position, turned.position.size());
  const PortraitView portrait(kDrawnSize);
  const fsm::Image picture = portrait.Draw(*fitted.base->head, turned, {});
  const auto faces = FindFaces(networks, picture);
  if (faces.empty()) return false;
  const FoundFace& seen = faces.front();
  for (ComparedPoint& point : points) {
    const MeshPoint& on_head = fitted.base->points[point.point];
    point.bias = (seen.At(point.point) - portrait.Pixel(on_head.On(turned.position))) *
                 portrait.mm_per_pixel();
    const float facing = on_head.On(turned.normal).z;
    point.weight = facing > 0.1F ? 1.0F : 0.15F;
  }
  return true;
}

/// Refined from several turns; the best.
CameraPose FindPose(const FittedHead& fitted, const FoundFace& face,
                    const std::vector<ComparedPoint>& points) {
  const glm::vec2 top = face.At(point::kNasion), chin = face.At(point::kChin);
  const float tall = glm::distance(fitted.At(point::kNasion), fitted.At(point::kChin));
  CameraPose start = fitted.pose;
  start.focal = fitted.pose.focal / fitted.pose.PixelsPerMm() * glm::distance(top, chin) / tall;
  const glm::vec2 down = chin - top;
  start.turn.z = std::atan2(-down.x, -down.y) + (down.y > 0 ? glm::radians(180.0F) : 0);
  if (start.turn.z > glm::radians(180.0F)) start.turn.z -= glm::radians(360.0F);
  std::optional<CameraPose> best;
  for (const float turn : {-60.0F, -30.0F, 0.0F, 30.0F, 60.0F}) {
    CameraPose from = start;
    from.turn = {0, glm::radians(turn), start.turn.z};
    from.centre = {0, 0};
    from.centre = face.At(point::kNoseBridge) - from.Pixel(fitted.At(point::kNoseBridge));
    const auto matches = MatchesOf(points, face, from);
    const CameraPose pose = RefinePose(matches, from);
    if (!best || MeanDistanceMm(pose, matches) < MeanDistanceMm(*best, matches)) best = pose;
  }
  return *best;
}

}  // namespace

vm::Result<PoseFit> FitExtraView(FaceNetworks& networks, const FittedHead& fitted,
                                 const ExtraPhoto& extra) {
  if (extra.faces.empty()) return vm::Fail(vm::Errc::kBadValue, "no face is found in it");
  const FoundFace& face = extra.faces.front();
  if (face.certainty < kLeastCertainty) {
    return vm::Fail(vm::Errc::kBadValue,
                    "no eyes, nose and mouth can be told apart in it; turned by 20 to 60 degrees "
                    "they can");
  }
  std::vector<ComparedPoint> points = ComparedPoints(fitted);
  PoseFit view{FindPose(fitted, face, points)};
  const float turn = std::abs(glm::degrees(view.pose.turn.y - fitted.pose.turn.y));
  if (turn < kLeastTurn) {
    return vm::Fail(vm::Errc::kBadValue,
                    "it shows the face from the front like the first; 20 to 60 degrees help");
  }
  if (turn > kMostTurn || !MeasureBias(networks, fitted, view.pose, points)) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the face is turned too far to be compared; 20 to 60 degrees can be");
  }
  const auto matches = MatchesOf(points, face, view.pose);
  view.pose = RefinePose(matches, view.pose);
  view.residual_mm = MeanDistanceMm(view.pose, matches);
  if (view.residual_mm > kMostResidual) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("its face does not fit the first photo's (points lie {:.1f} mm "
                                "apart); is it the same person?",
                                view.residual_mm));
  }
  return view;
}

void RefineDepthByStereo(const fsm::Image& front, const fsm::Image& extra, CameraPose& pose,
                         Fit& fit) {
  for (int round = 0; round < 2; ++round) {
    const auto depths = CompareDepth(fit.head, front, extra, pose);
    if (depths.empty()) return;
    // What the far cheek hides is taken to be as the near one.
    std::vector<fsm::WarpPoint> both = depths;
    const glm::vec3 towards = pose.TowardsCamera();
    for (const fsm::WarpPoint& point : depths) {
      if (point.at.x * towards.x > 0 && std::abs(point.at.x) > 12) {
        both.push_back({point.at * glm::vec3(-1, 1, 1), point.by});
      }
    }
    // Some single patches are mistaken: those far from what their neighbours say are left out.
    constexpr float kSmooth = 60, kEvenly = 12, kFar = 2, kMost = 10;
    const fsm::Warp rough(both, kSmooth);
    std::erase_if(both, [&](const fsm::WarpPoint& point) {
      return std::abs(rough.Motion(point.at).z - point.by.z) > kFar;
    });
    if (both.size() < 20) return;
    const fsm::Warp depth(both, kEvenly);
    for (LandmarkConstraint& constraint : fit.targets.constraints) {
      constraint.z += std::clamp(
          depth.Motion(constraint.on_head.On(fit.head.base->rest.position)).z, -kMost, kMost);
    }
    WarpToLandmarks(fit.targets, fit.head);
  }
}

}  // namespace facefit
