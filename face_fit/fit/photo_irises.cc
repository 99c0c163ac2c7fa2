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

/// Returns where a photo shows an eye with these lids if it is formed as the base head's.
ExpectedEye ExpectEye(const ObservedHead& base, const EyePoints& lids, fsm::Side side) {
  // The base head's eye in millimetres, y down.
  const EyePoints on_base = EyePointsOf(
      side, [&base](PointIndex i) { return glm::vec2(1, -1) * glm::vec2(base.AtRest(i)); });
  const glm::vec3 ball = base.head().EyeCentre(side);
  const glm::vec2 from = AcrossEye(on_base), to = AcrossEye(lids);
  const float pixels_per_mm = glm::length(to) / std::max(glm::length(from), 1e-3F);
  const float angle_rad = AngleOf(to) - AngleOf(from);
  const glm::vec2 from_middle = glm::vec2(ball.x, -ball.y) - MiddleOfLids(on_base);
  return {.lids = lids,
          .iris_centre_px = MiddleOfLids(lids) + pixels_per_mm * Rotated(from_middle, angle_rad),
          .iris_radius_px = pixels_per_mm * base.surface().eyes[side].iris_radius,
          .pixels_per_mm = pixels_per_mm};
}

}  // namespace

glm::vec2 LidShiftPx(const PhotoIris& iris) {
  if (!iris.seen) return {0, 0};
  const glm::vec2 axis = glm::normalize(AcrossEye(iris.expected.lids));
  const glm::vec2 across(-axis.y, axis.x);
  const float free_px = kFreeRestMm * iris.expected.pixels_per_mm;
  const float max_px = kMaxShiftMm * iris.expected.pixels_per_mm;
  const float shift_px = std::clamp(
      glm::dot(iris.circle.centre_px - iris.expected.iris_centre_px, across), -max_px, max_px);
  if (std::abs(shift_px) <= free_px) return {0, 0};
  return (shift_px - std::copysign(free_px, shift_px)) * across;
}

PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image& photo) {
  const auto expected = [&](fsm::Side side) {
    return ExpectEye(base, EyePointsOf(side, face), side);
  };
  const fsm::Sided<ExpectedEye> eyes{expected(fsm::Side::kRight), expected(fsm::Side::kLeft)};
  const auto found = FindIrises(photo, eyes);
  PhotoIrises irises;
  float size = 0, count = 0;
  for (const fsm::Side side : fsm::kSides) {
    const ExpectedEye& eye = eyes[side];
    const bool seen = found[side].contrast >= kClearIris;
    irises.eyes[side] = {seen ? found[side] : IrisCircle{eye.iris_centre_px, eye.iris_radius_px, 0},
                         eye, seen};
    if (!seen) continue;
    size += found[side].radius_px / eye.iris_radius_px;
    count += 1;
  }
  if (count > 0) irises.size = kIrisSize.Clamp(size / count);
  return irises;
}

}  // namespace facefit
