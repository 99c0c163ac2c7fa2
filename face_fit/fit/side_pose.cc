#include "face_fit/fit/side_pose.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "face_fit/find/head/portrait_view.h"
#include "fsm/rig/normals.h"

namespace facefit {
namespace {

constexpr int kDrawnSize = 640;
/// Below it a photo tells no more of depth than the first one did; beyond it the network guesses.
constexpr float kMinTurnDeg = 12, kMaxTurnDeg = 80;
/// Of a turned face the network is less sure than of one from the front (kCertainFace).
constexpr float kMinCertainty = 0.5F;
/// Points of the same face drawn and seen lie nearer than that, those of another mostly do not.
constexpr float kMaxResidualMm = 2.6F;
/// From that cosine of the slant on the network tells where a point lies, below it guesses.
constexpr float kToldFacing = 0.1F, kGuessedWeight = 0.15F;
/// Turns from which a pose is looked for: near enough to each other that one leads to the best.
constexpr float kStartTurnsDeg[] = {-60, -30, 0, 30, 60};

/// What can be compared: points of the network with the place of the posed head, and how far beside
/// it the network sees them (millimetres to the right and down, as the camera has it).
struct ComparedPoint {
  PointIndex point;
  glm::vec3 place;
  glm::vec2 bias_mm{0};
  float weight = 1;
};

std::vector<ComparedPoint> ComparedPoints(const FittedHead& fitted) {
  std::vector<ComparedPoint> points;
  for (const PointIndex i : point::kForFit) points.push_back({i, fitted.PlaceOf(i)});
  return points;
}

/// The points as matches for RefinePose, the bias taken off.
std::vector<PointMatch> MatchesOf(const std::vector<ComparedPoint>& points, const FoundFace& face,
                                  const CameraPose& pose) {
  std::vector<PointMatch> matches;
  for (const ComparedPoint& point : points) {
    matches.push_back({point.place, face.PixelOf(point.point) - point.bias_mm * pose.PixelsPerMm(),
                       point.weight});
  }
  return matches;
}

/// Draws the posed head turned as in the pose and lets the network look at it. Returns the points
/// with how far beside their places it sees them, those that are turned away with little weight;
/// nothing if it sees no face.
std::optional<std::vector<ComparedPoint>> MeasuredBias(FaceNetworks& networks,
                                                       const FittedHead& fitted,
                                                       const CameraPose& pose,
                                                       std::vector<ComparedPoint> points) {
  fsm::HeadVertices turned;
  for (const glm::vec3& p : fitted.posed_vertices) turned.position.push_back(pose.ToCamera(p));
  turned.normal =
      fsm::Normals(fitted.base->head().topology().indices, turned.position, turned.position.size());
  const PortraitView portrait(kDrawnSize);
  const fsm::Image picture = portrait.Draw(fitted.base->head(), turned, {});
  const auto faces = FindFaces(networks, picture);
  if (faces.empty()) return std::nullopt;
  for (ComparedPoint& point : points) {
    const MeshPoint& on_head = fitted.base->places()[point.point];
    point.bias_mm =
        (faces.front().PixelOf(point.point) - portrait.Pixel(on_head.On(turned.position))) *
        portrait.mm_per_pixel();
    point.weight = on_head.On(turned.normal).z > kToldFacing ? 1.0F : kGuessedWeight;
  }
  return points;
}

/// Refined from several turns; the best.
CameraPose FindPose(const FittedHead& fitted, const FoundFace& face,
                    const std::vector<ComparedPoint>& points) {
  const glm::vec2 top = face.PixelOf(point::kNasion), chin = face.PixelOf(point::kChin);
  const float height_mm =
      glm::distance(fitted.PlaceOf(point::kNasion), fitted.PlaceOf(point::kChin));
  const float focal =
      fitted.pose.focal / fitted.pose.PixelsPerMm() * glm::distance(top, chin) / height_mm;
  const glm::vec2 down = chin - top;
  const float tilt_rad = std::atan2(down.x, down.y);
  std::optional<CameraPose> best;
  for (const float turn_deg : kStartTurnsDeg) {
    CameraPose start{.turn_rad = {0, glm::radians(turn_deg), tilt_rad}, .focal = focal};
    start.centre =
        face.PixelOf(point::kNoseBridge) - start.Pixel(fitted.PlaceOf(point::kNoseBridge));
    const auto matches = MatchesOf(points, face, start);
    const CameraPose pose = RefinePose(matches, start);
    if (!best || MeanDistanceMm(pose, matches) < MeanDistanceMm(*best, matches)) best = pose;
  }
  return *best;
}

}  // namespace

vm::Result<CameraPose> FitSidePose(FaceNetworks& networks, const FittedHead& fitted,
                                   const SidePhoto& side_photo) {
  if (side_photo.faces.empty()) return vm::Fail(vm::Errc::kBadValue, "no face is found in it");
  const FoundFace& face = side_photo.faces.front();
  if (face.certainty < kMinCertainty) {
    return vm::Fail(vm::Errc::kBadValue,
                    "no eyes, nose and mouth can be told apart in it; turned by 20 to 60 degrees "
                    "they can");
  }
  const std::vector<ComparedPoint> points = ComparedPoints(fitted);
  const CameraPose found = FindPose(fitted, face, points);
  const float turn_deg = std::abs(glm::degrees(found.turn_rad.y - fitted.pose.turn_rad.y));
  if (turn_deg < kMinTurnDeg) {
    return vm::Fail(vm::Errc::kBadValue,
                    "it shows the face from the front like the first; 20 to 60 degrees help");
  }
  std::optional<std::vector<ComparedPoint>> measured;
  if (turn_deg <= kMaxTurnDeg) measured = MeasuredBias(networks, fitted, found, points);
  if (!measured) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the face is turned too far to be compared; 20 to 60 degrees can be");
  }
  const auto matches = MatchesOf(*measured, face, found);
  const CameraPose pose = RefinePose(matches, found);
  const float residual_mm = MeanDistanceMm(pose, matches);
  if (residual_mm > kMaxResidualMm) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("its face does not fit the first photo's (points lie {:.1f} mm "
                                "apart); is it the same person?",
                                residual_mm));
  }
  return pose;
}

}  // namespace facefit
