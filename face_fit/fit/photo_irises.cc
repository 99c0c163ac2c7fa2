#include "face_fit/fit/photo_irises.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/image/plane.h"
#include "fsm/base/range.h"

namespace facefit {
namespace {

/// Distance of an iris above or below the middle between the lids that counts as normal, since eyes
/// rest differently; and the most by which lids are moved.
constexpr float kFreeRestMm = 0.5F, kMaxShiftMm = 3;

/// Plausible limits of an iris, relative to the built-in one.
constexpr fsm::Range kIrisSize{0.8F, 1.12F};

/// Returns the way from the outer to the inner corner of an eye.
glm::vec2 AcrossEye(const EyePoints& lids) { return lids[kInnerCorner] - lids[kOuterCorner]; }
glm::vec2 MiddleOfLids(const EyePoints& lids) {
  return 0.5F * (lids[kUpperMiddle] + lids[kLowerMiddle]);
}

}  // namespace

IrisPlacement ExpectedIris(const ObservedHead& base, const EyePoints& lids, fsm::Side side) {
  // The base head's eye in millimetres, y down.
  const EyePoints own = EyePointsOf(
      side, [&base](PointIndex i) { return glm::vec2(1, -1) * glm::vec2(base.AtRest(i)); });
  const glm::vec3 ball = base.head().EyeCentre(side);
  const glm::vec2 from = AcrossEye(own), to = AcrossEye(lids);
  const float pixels_per_mm = glm::length(to) / std::max(glm::length(from), 1e-3F);
  const float angle_rad = AngleOf(to) - AngleOf(from);
  const glm::vec2 from_middle = glm::vec2(ball.x, -ball.y) - MiddleOfLids(own);
  return {MiddleOfLids(lids) + pixels_per_mm * Rotated(from_middle, angle_rad), pixels_per_mm};
}

glm::vec2 LidShiftPx(const ObservedHead& base, const EyePoints& lids, const IrisCircle& iris,
                     fsm::Side side) {
  if (iris.contrast <= 0) return {0, 0};
  const IrisPlacement expected = ExpectedIris(base, lids, side);
  const glm::vec2 axis = glm::normalize(AcrossEye(lids));
  const glm::vec2 across(-axis.y, axis.x);
  const float free_px = kFreeRestMm * expected.pixels_per_mm;
  const float max_px = kMaxShiftMm * expected.pixels_per_mm;
  const float shift_px =
      std::clamp(glm::dot(iris.centre_px - expected.centre_px, across), -max_px, max_px);
  if (std::abs(shift_px) <= free_px) return {0, 0};
  return (shift_px - std::copysign(free_px, shift_px)) * across;
}

PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image& photo) {
  PhotoIrises irises;
  fsm::Sided<ExpectedEye> eyes;
  for (const fsm::Side side : fsm::kSides) {
    eyes[side].lids = EyePointsOf(side, face);
    const IrisPlacement iris = ExpectedIris(base, eyes[side].lids, side);
    eyes[side].iris_centre_px = iris.centre_px;
    eyes[side].iris_radius_px = iris.pixels_per_mm * base.head().surface().eyes[side].iris_radius;
    irises.circles[side] = {
        .centre_px = iris.centre_px, .radius_px = eyes[side].iris_radius_px, .contrast = 0};
  }
  const auto found = FindIrises(photo, eyes);
  float size = 0, count = 0;
  for (const fsm::Side side : fsm::kSides) {
    const IrisCircle& iris = found[side];
    if (iris.contrast < kClearIris) continue;
    irises.circles[side] = iris;
    size += iris.radius_px / eyes[side].iris_radius_px;
    count += 1;
  }
  if (count > 0) irises.size = kIrisSize.Clamp(size / count);
  return irises;
}

}  // namespace facefit
