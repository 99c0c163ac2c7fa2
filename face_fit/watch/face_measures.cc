#include "face_fit/watch/face_measures.h"

#include <glm/geometric.hpp>

#include "face_fit/fit/camera_pose.h"
#include "fsm/mesh/head_points.h"

namespace facefit {
namespace {

glm::vec3 Middle(std::span<const glm::vec3> points, std::span<const PointIndex> of) {
  glm::vec3 sum(0);
  for (const PointIndex i : of) sum += points[i];
  return sum / static_cast<float>(of.size());
}

/// How far an opening is open, the mean of three places about its middle. `upper`, `lower`: where
/// its middle is in the lists of its edges' points; `step`: 1 if the lower one runs along the upper
/// one, -1 if it runs back.
float MeanGap(std::span<const glm::vec3> points, std::span<const PointIndex>::iterator upper,
              std::span<const PointIndex>::iterator lower, int step) {
  float sum = 0;
  for (const int k : {-1, 0, 1}) {
    sum += glm::length(glm::vec2(points[upper[k]] - points[lower[step * k]]));
  }
  return sum / 3;
}

/// Where both irises look: from the middle between the corners of their eyes.
glm::vec2 GazeOf(const AttentiveFace& found) {
  glm::vec2 sum(0);
  for (const fsm::Side side : fsm::kSides) {
    const glm::vec2 a = found.face.At(EyeOutline(side)[kOuterCorner]),
                    b = found.face.At(EyeOutline(side)[kInnerCorner]);
    const glm::vec2 across = side == fsm::Side::kRight ? b - a : a - b;
    const glm::vec2 iris = found.iris[side][0];
    const glm::vec2 off = (iris - 0.5F * (a + b)) / glm::dot(across, across);
    sum += glm::vec2(glm::dot(off, across), off.x * across.y - off.y * across.x);
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
  const auto middle = [](std::span<const PointIndex> list) {
    return list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
  };
  measures.gap = MeanGap(points, middle(point::kUpperInnerLip), middle(point::kLowerInnerLip), 1);
  measures.width = glm::distance(points[point::kMouthRight], points[point::kMouthLeft]);
  measures.jaw = points[point::kNoseBottom].y - points[point::kChin].y;
  const float eyes = 0.25F * (points[point::kEyeOuterRight].y + points[point::kEyeInnerRight].y +
                              points[point::kEyeInnerLeft].y + points[point::kEyeOuterLeft].y);
  constexpr fsm::Sided<PointIndex> kCorner{point::kMouthRight, point::kMouthLeft};
  for (const fsm::Side side : fsm::kSides) {
    const auto lids = EyeOutline(side).begin();
    measures.corner_up[side] = points[kCorner[side]].y - points[point::kNoseBottom].y;
    measures.eye[side] = MeanGap(points, lids + kUpperMiddle, lids + kLowerMiddle, -1);
    measures.brow_inner[side] = Middle(points, point::kBrowInner[side]).y - eyes;
    measures.brow_outer[side] = Middle(points, point::kBrowOuter[side]).y - eyes;
  }
  const auto [down, across, tilted] = AnglesOf(glm::transpose(back.turn));
  measures.turn_deg = {down, across, tilted};
  measures.gaze = GazeOf(found);
  return measures;
}

}  // namespace facefit
