#include "face_fit/side/side_pose.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "face_fit/find/head/portrait_view.h"
#include "face_fit/find/network/face_finder.h"
#include "fsm/rig/normals.h"

namespace facefit {
namespace {

constexpr int kDrawnSize = 640;
/// Range of turns relative to the front photo: a smaller turn adds no information on depth, at a
/// larger one the network guesses.
constexpr float kMinTurnDeg = 12, kMaxTurnDeg = 80;
/// The network is less certain of a turned face than of one from the front (kCertainFace).
constexpr float kMinCertainty = 0.5F;
/// Greatest mean distance of points seen and drawn of one face; other faces mostly exceed it.
constexpr float kMaxResidualMm = 2.6F;
/// Mean distance that no two people's faces have (measured on drawn heads: at most 4 mm): the
/// network has misplaced the points, as it does now and then in full profile (13 mm).
constexpr float kMisplacedMm = 8;
/// Cosine of the angle to the camera above which the network sees a point; weight of those below
/// it, which it guesses.
constexpr float kMinSeenFacing = 0.1F, kGuessedWeight = 0.15F;
/// Turns from which a pose is refined, close enough that one converges to the best.
constexpr float kStartTurnsDeg[] = {-60, -30, 0, 30, 60};

/// A point of the network, its position on the fitted head, head's frame, and the network's error
/// there (millimetres right and down in the image).
struct ComparedPoint {
  PointIndex index;
  glm::vec3 position;
  glm::vec2 bias_mm{0};
  float weight = 1;
};

std::vector<ComparedPoint> ComparedPoints(const FittedHead& fitted) {
  std::vector<ComparedPoint> points;
  for (const PointIndex i : point::kReliable) points.push_back({i, fitted.PositionOf(i)});
  return points;
}

/// Returns the points as matches for FitPose, with the network's errors subtracted.
std::vector<PointMatch> MatchesOf(const std::vector<ComparedPoint>& points, const FoundFace& face,
                                  const CameraPose& pose) {
  std::vector<PointMatch> matches;
  for (const ComparedPoint& compared : points) {
    matches.push_back({compared.position,
                       face.PixelOf(compared.index) - compared.bias_mm * pose.PixelsPerMm(),
                       compared.weight});
  }
  return matches;
}

/// Measures the network's errors on the fitted head drawn in a pose. Returns the points with errors
/// and weights, small for those turned away; nothing if the network sees no face.
std::optional<std::vector<ComparedPoint>> MeasuredBias(FaceNetworks& networks,
                                                       const FittedHead& fitted,
                                                       const CameraPose& pose,
                                                       std::vector<ComparedPoint> points) {
  fsm::HeadVertices turned;
  turned.position = pose.ToCamera(fitted.vertices);
  turned.normal =
      fsm::Normals(fitted.base->surface().indices, turned.position, turned.position.size());
  const PortraitView portrait(kDrawnSize);
  const fsm::Image image = portrait.Draw(fitted.base->head(), turned, {});
  const auto faces = FindFaces(networks, image);
  if (faces.empty()) return std::nullopt;
  for (ComparedPoint& compared : points) {
    const MeshPoint& on_head = fitted.base->mesh_points()[compared.index];
    compared.bias_mm =
        (faces.front().PixelOf(compared.index) - portrait.PixelOf(on_head.On(turned.position))) *
        portrait.mm_per_pixel();
    compared.weight = on_head.On(turned.normal).z > kMinSeenFacing ? 1.0F : kGuessedWeight;
  }
  return points;
}

/// Returns the best of the poses refined from several turns.
CameraPose FindPose(const FittedHead& fitted, const FoundFace& face,
                    const std::vector<ComparedPoint>& points) {
  const glm::vec2 top = face.PixelOf(point::kNasion), chin = face.PixelOf(point::kChin);
  const float height_mm =
      glm::distance(fitted.PositionOf(point::kNasion), fitted.PositionOf(point::kChin));
  const float focal =
      fitted.pose.focal_px / fitted.pose.PixelsPerMm() * glm::distance(top, chin) / height_mm;
  const glm::vec2 down = chin - top;
  const float tilt_rad = std::atan2(down.x, down.y);
  std::optional<CameraPose> best;
  for (const float turn_deg : kStartTurnsDeg) {
    CameraPose start{.rotation_rad = {0, glm::radians(turn_deg), tilt_rad}, .focal_px = focal};
    start.centre_px =
        face.PixelOf(point::kNoseBridge) - start.PixelOf(fitted.PositionOf(point::kNoseBridge));
    const auto matches = MatchesOf(points, face, start);
    const CameraPose pose = FitPose(matches, start);
    if (!best || MeanDistanceMm(pose, matches) < MeanDistanceMm(*best, matches)) best = pose;
  }
  return *best;
}

}  // namespace

std::expected<CameraPose, NoSidePose> FitSidePose(FaceNetworks& networks, const FittedHead& fitted,
                                                  const SidePhoto& side_photo) {
  using std::unexpected;
  if (!side_photo.face) return unexpected(NoSidePose{true, "no face is found in it"});
  const FoundFace& face = *side_photo.face;
  if (face.certainty < kMinCertainty) {
    return unexpected(NoSidePose{true,
                                 "no eyes, nose and mouth can be told apart in it; turned by 20 to "
                                 "60 degrees they can"});
  }
  const std::vector<ComparedPoint> points = ComparedPoints(fitted);
  const CameraPose found = FindPose(fitted, face, points);
  const float turn_deg = std::abs(glm::degrees(found.rotation_rad.y - fitted.pose.rotation_rad.y));
  if (turn_deg < kMinTurnDeg) {
    // In full profile the network now and then sees a face from the front, which does not fit.
    const float residual_mm = MeanDistanceMm(found, MatchesOf(points, face, found));
    if (residual_mm > kMaxResidualMm) {
      return unexpected(NoSidePose{
          true, fmt::format("the face seen in it is from the front and does not fit the front "
                            "photo's (points lie {:.1f} mm apart); the same person, turned by 20 "
                            "to 60 degrees, helps",
                            residual_mm)});
    }
    return unexpected(NoSidePose{
        false, "it shows the face from the front like the front photo; 20 to 60 degrees help"});
  }
  std::optional<std::vector<ComparedPoint>> measured;
  if (turn_deg <= kMaxTurnDeg) measured = MeasuredBias(networks, fitted, found, points);
  if (!measured) {
    return unexpected(
        NoSidePose{true, "the face is turned too far to be compared; 20 to 60 degrees can be"});
  }
  const auto matches = MatchesOf(*measured, face, found);
  const CameraPose pose = FitPose(matches, found);
  const float residual_mm = MeanDistanceMm(pose, matches);
  if (residual_mm > kMaxResidualMm) {
    return unexpected(NoSidePose{
        residual_mm > kMisplacedMm,
        fmt::format("its face does not fit the front photo's (points lie {:.1f} mm apart); is it "
                    "the same person?",
                    residual_mm)});
  }
  return pose;
}

}  // namespace facefit
