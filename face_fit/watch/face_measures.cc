#include "face_fit/watch/face_measures.h"

#include <array>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/fit/camera_pose.h"
#include "fsm/mesh/head_points.h"

namespace facefit {
namespace {

glm::vec3 Middle(std::span<const glm::vec3> points, std::span<const PointIndex> of) {
  glm::vec3 sum(0);
  for (const PointIndex i : of) sum += points[i];
  return sum / static_cast<float>(of.size());
}

/// Pairs of points on the upper and lower edge of an opening, above each other near its middle.
using EdgePairs = std::array<std::pair<PointIndex, PointIndex>, 3>;
constexpr EdgePairs kLips = {{{82, 87}, {13, 14}, {312, 317}}};
constexpr fsm::Sided<EdgePairs> kLids = {{{{160, 144}, {159, 145}, {158, 153}}},
                                         {{{387, 373}, {386, 374}, {385, 380}}}};

/// Returns the mean distance of these pairs.
float MeanGap(std::span<const glm::vec3> points, const EdgePairs& pairs) {
  float sum = 0;
  for (const auto& [upper, lower] : pairs) {
    sum += glm::length(glm::vec2(points[upper] - points[lower]));
  }
  return sum / 3;
}

/// Returns FaceMeasures::gaze.
glm::vec2 GazeOf(const AttentiveFace& found) {
  glm::vec2 sum(0);
  for (const fsm::Side side : fsm::kSides) {
    const glm::vec2 a = found.face.PixelOf(point::kEyeOutline[side][kOuterCorner]),
                    b = found.face.PixelOf(point::kEyeOutline[side][kInnerCorner]);
    const glm::vec2 across = side == fsm::Side::kRight ? b - a : a - b;
    const glm::vec2 iris = found.iris[side][0];
    const glm::vec2 gaze = (iris - 0.5F * (a + b)) / glm::dot(across, across);
    sum += glm::vec2(glm::dot(gaze, across), gaze.x * across.y - gaze.y * across.x);
  }
  return 0.5F * sum;
}

}  // namespace

std::vector<glm::vec3> PointsInMm(const FoundFace& face) {
  const float scale = kEyesApartMm / glm::length(face.points[point::kEyeOuterLeft] -
                                                 face.points[point::kEyeOuterRight]);
  std::vector<glm::vec3> points;
  for (const glm::vec3& p : face.points) points.push_back(scale * glm::vec3(p.x, -p.y, p.z));
  return points;
}

FaceMeasures Measure(const AttentiveFace& found, std::span<const glm::vec3> first) {
  std::vector<glm::vec3> points = PointsInMm(found.face);
  std::vector<fsm::PointPair> pairs;
  for (const PointIndex i : point::kStill) pairs.push_back({.from = first[i], .to = points[i]});
  const fsm::Similarity back = fsm::FitSimilarity(pairs);
  for (glm::vec3& p : points) p = back(p);

  FaceMeasures measures{.certainty = found.face.certainty};
  measures.gap_mm = MeanGap(points, kLips);
  measures.width_mm = glm::distance(points[point::kMouthRight], points[point::kMouthLeft]);
  measures.jaw_mm = points[point::kNoseBottom].y - points[point::kChin].y;
  const float eyes = 0.25F * (points[point::kEyeOuterRight].y + points[point::kEyeInnerRight].y +
                              points[point::kEyeInnerLeft].y + points[point::kEyeOuterLeft].y);
  constexpr fsm::Sided<PointIndex> kCorner{point::kMouthRight, point::kMouthLeft};
  for (const fsm::Side side : fsm::kSides) {
    measures.corner_up_mm[side] = points[kCorner[side]].y - points[point::kNoseBottom].y;
    measures.eye_mm[side] = MeanGap(points, kLids[side]);
    measures.brow_inner_mm[side] = Middle(points, point::kBrowInner[side]).y - eyes;
    measures.brow_outer_mm[side] = Middle(points, point::kBrowOuter[side]).y - eyes;
  }
  const auto [down, across, tilted] = HeadRotationOf(glm::transpose(back.rotation));
  measures.turn_deg = {down, across, tilted};
  measures.gaze = GazeOf(found);
  return measures;
}

}  // namespace facefit
