#include "face_fit/watch/face_measures.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "fsm/mesh/head_points.h"

namespace facefit {
namespace {

constexpr float kEyesApart = 90;  // mm

/// Points that neither speech nor brows nor lids move much: the nose's bridge, both corners of both
/// eyes, temples, the sides of the face above the jaw.
constexpr PointIndex kStill[] = {168, 6,   197, 195, 33,  133, 362, 263, 127, 356,
                                 234, 454, 162, 389, 139, 368, 34,  264, 143, 372};

struct Side {
  PointIndex mouth, eye_outer, eye_inner;
  std::array<PointIndex, 3> upper_lid, lower_lid, brow_inner, brow_outer;
};
constexpr Side kSides[] = {
    {61, 33, 133, {160, 159, 158}, {144, 145, 153}, {107, 66, 55}, {70, 63, 46}},
    {291, 263, 362, {387, 386, 385}, {373, 374, 380}, {336, 296, 285}, {300, 293, 276}}};
constexpr std::array<PointIndex, 3> kUpperLip = {82, 13, 312}, kLowerLip = {87, 14, 317};

glm::vec3 Middle(std::span<const glm::vec3> points, std::span<const PointIndex> of) {
  glm::vec3 sum(0);
  for (const PointIndex i : of) sum += points[i];
  return sum / static_cast<float>(of.size());
}

float MeanDistance(std::span<const glm::vec3> points, std::span<const PointIndex> a,
                   std::span<const PointIndex> b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += glm::length(glm::vec2(points[a[i]] - points[b[i]]));
  }
  return sum / static_cast<float>(a.size());
}

/// Degrees of a turn that is the product of those about y, x and z: as FaceState::head_rotation.
glm::vec3 AnglesOf(const glm::mat3& turn) {
  const float x = std::asin(glm::clamp(-turn[2][1], -1.0F, 1.0F));
  const float y = std::atan2(turn[2][0], turn[2][2]);
  const float z = std::atan2(-turn[0][1], turn[1][1]);
  return glm::degrees(glm::vec3(x, y, z));
}

/// Where both irises look: from the middle between the corners of their eyes.
std::array<float, 2> GazeOf(const AttentiveFace& found) {
  glm::vec2 sum(0);
  for (std::size_t side = 0; side < 2; ++side) {
    const glm::vec2 a = found.face.At(kSides[side].eye_outer),
                    b = found.face.At(kSides[side].eye_inner);
    const glm::vec2 across = side == 0 ? b - a : a - b;
    const glm::vec2 off = (found.iris[side][0] - 0.5F * (a + b)) / glm::dot(across, across);
    sum += glm::vec2(glm::dot(off, across), off.x * across.y - off.y * across.x);
  }
  return {0.5F * sum.x, 0.5F * sum.y};
}

}  // namespace

FaceMeasures FaceMeasurer::Measure(const AttentiveFace& found) {
  const float scale = kEyesApart / glm::length(found.face.points[point::kEyeOuterLeft] -
                                               found.face.points[point::kEyeOuterRight]);
  std::vector<glm::vec3> points;
  for (const glm::vec3& p : found.face.points) points.push_back(scale * glm::vec3(p.x, -p.y, p.z));
  if (first_.empty()) first_ = points;
  std::vector<fsm::PointPair> pairs;
  for (const PointIndex i : kStill) pairs.push_back({.from = first_[i], .to = points[i]});
  const fsm::Similarity back = fsm::FitSimilarity(pairs);
  for (glm::vec3& p : points) p = back(p);

  FaceMeasures measures{.certainty = found.face.certainty};
  measures.gap = MeanDistance(points, kUpperLip, kLowerLip);
  measures.width = glm::distance(points[point::kMouthRight], points[point::kMouthLeft]);
  measures.jaw = points[point::kNoseBottom].y - points[point::kChin].y;
  const float eyes = 0.25F * (points[33].y + points[133].y + points[362].y + points[263].y);
  for (std::size_t side = 0; side < 2; ++side) {
    const Side& of = kSides[side];
    measures.corner_up[side] = points[of.mouth].y - points[point::kNoseBottom].y;
    measures.eye[side] = MeanDistance(points, of.upper_lid, of.lower_lid);
    measures.brow_inner[side] = Middle(points, of.brow_inner).y - eyes;
    measures.brow_outer[side] = Middle(points, of.brow_outer).y - eyes;
  }
  measures.turn_deg = AnglesOf(glm::transpose(back.turn));
  measures.gaze = GazeOf(found);
  return measures;
}

}  // namespace facefit
