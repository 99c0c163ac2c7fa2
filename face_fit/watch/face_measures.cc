#include "face_fit/watch/face_measures.h"

#include <glm/geometric.hpp>
#include <utility>

#include "fsm/mesh/head_points.h"
#include "fsm/rig/angles.h"

namespace facefit {
namespace {

glm::vec3 Middle(std::span<const glm::vec3> points, std::span<const PointIndex> of) {
  glm::vec3 sum(0);
  for (const PointIndex i : of) sum += points[i];
  return sum / static_cast<float>(of.size());
}

/// Returns the mean distance of the edges of an opening at three places next to its middle.
/// `edges_at(k)`: the points of its upper and lower edge there, k from 0 to 2.
float MeanGap(std::span<const glm::vec3> points, auto edges_at) {
  float sum = 0;
  for (const std::size_t k : {0U, 1U, 2U}) {
    const auto [upper, lower] = edges_at(k);
    sum += glm::length(glm::vec2(points[upper] - points[lower]));
  }
  return sum / 3;
}
std::pair<PointIndex, PointIndex> LipPointsAt(std::size_t k) {
  constexpr std::size_t kMiddle = point::kUpperInnerLip.size() / 2;
  return {point::kUpperInnerLip[kMiddle - 1 + k], point::kLowerInnerLip[kMiddle - 1 + k]};
}
std::pair<PointIndex, PointIndex> LidPointsAt(fsm::Side side, std::size_t k) {
  const auto& outline = point::kEyeOutline[side];
  return {outline[kUpperMiddle - 1 + k], outline[kLowerMiddle + 1 - k]};
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
  for (const PointIndex i : point::kRigid) pairs.push_back({.from = first[i], .to = points[i]});
  const fsm::Similarity back = fsm::FitSimilarity(pairs);
  for (glm::vec3& p : points) p = back(p);

  FaceMeasures measures{.certainty = found.face.certainty};
  measures.gap_mm = MeanGap(points, LipPointsAt);
  measures.width_mm = glm::distance(points[point::kMouthRight], points[point::kMouthLeft]);
  measures.jaw_mm = points[point::kNoseBottom].y - points[point::kChin].y;
  const float eyes = 0.25F * (points[point::kEyeOuterRight].y + points[point::kEyeInnerRight].y +
                              points[point::kEyeInnerLeft].y + points[point::kEyeOuterLeft].y);
  constexpr fsm::Sided<PointIndex> kCorner{point::kMouthRight, point::kMouthLeft};
  for (const fsm::Side side : fsm::kSides) {
    measures.corner_up_mm[side] = points[kCorner[side]].y - points[point::kNoseBottom].y;
    measures.eye_mm[side] = MeanGap(points, [side](std::size_t k) { return LidPointsAt(side, k); });
    measures.brow_inner_mm[side] = Middle(points, point::kBrowInner[side]).y - eyes;
    measures.brow_outer_mm[side] = Middle(points, point::kBrowOuter[side]).y - eyes;
  }
  const auto [down, across, tilted] = fsm::HeadRotationOf(glm::transpose(back.rotation));
  measures.turn_deg = {down, across, tilted};
  measures.gaze = GazeOf(found);
  return measures;
}

}  // namespace facefit
