#include "face_fit/fit/photo_irises.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/picture/plane.h"

namespace facefit {
namespace {

/// Distance of an iris above or below the middle between the lids that counts as normal, since eyes
/// rest differently; and the most by which lids are moved.
constexpr float kFreeRestMm = 0.5F, kMaxShiftMm = 3;

/// Plausible limits of an iris, relative to the built-in one.
constexpr glm::vec2 kIrisSize{0.8F, 1.12F};

}  // namespace

IrisPlacement ExpectedIris(const ObservedHead& base, const LidSpan& lids, fsm::Side side) {
  // The base head's eye in millimetres, y down.
  const LidSpan own = LidSpanOf(
      side, [&base](PointIndex i) { return glm::vec2(1, -1) * glm::vec2(base.AtRest(i)); });
  const glm::vec3 ball = base.head().topology().eyes[side].centre;
  const glm::vec2 from = own.inner - own.outer, to = lids.inner - lids.outer;
  const float pixels_per_mm = glm::length(to) / std::max(glm::length(from), 1e-3F);
  const float angle_rad = std::atan2(to.y, to.x) - std::atan2(from.y, from.x);
  const glm::vec2 from_middle = glm::vec2(ball.x, -ball.y) - own.middle;
  return {lids.middle + pixels_per_mm * Rotated(from_middle, angle_rad), pixels_per_mm};
}

glm::vec2 LidShiftPx(const ObservedHead& base, const LidSpan& lids, const IrisCircle& iris,
                     fsm::Side side) {
  if (iris.contrast <= 0) return {0, 0};
  const IrisPlacement expected = ExpectedIris(base, lids, side);
  const glm::vec2 axis = glm::normalize(lids.inner - lids.outer);
  const glm::vec2 across(-axis.y, axis.x);
  const float free_px = kFreeRestMm * expected.pixels_per_mm;
  const float max_px = kMaxShiftMm * expected.pixels_per_mm;
  const float shift_px =
      std::clamp(glm::dot(iris.centre - expected.centre, across), -max_px, max_px);
  if (std::abs(shift_px) <= free_px) return {0, 0};
  return (shift_px - std::copysign(free_px, shift_px)) * across;
}

PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image* photo) {
  PhotoIrises irises;
  fsm::Sided<ExpectedEye> eyes;
  for (const fsm::Side side : fsm::kSides) {
    const auto pixel_of = [&face](PointIndex i) { return face.PixelOf(i); };
    const IrisPlacement iris = ExpectedIris(base, LidSpanOf(side, pixel_of), side);
    eyes[side].lids = EyePointsOf(side, pixel_of);
    eyes[side].iris_centre = iris.centre;
    eyes[side].iris_radius = iris.pixels_per_mm * base.head().topology().eyes[side].iris_radius;
    irises.circles[side] = {.centre = iris.centre, .radius = eyes[side].iris_radius, .contrast = 0};
  }
  if (!photo) return irises;
  const auto found = FindIrises(*photo, eyes);
  float size = 0, count = 0;
  for (const fsm::Side side : fsm::kSides) {
    const IrisCircle& iris = found[side];
    if (iris.contrast < kClearIris) continue;
    irises.circles[side] = iris;
    size += iris.radius / eyes[side].iris_radius;
    count += 1;
  }
  if (count > 0) irises.size = std::clamp(size / count, kIrisSize.x, kIrisSize.y);
  return irises;
}

}  // namespace facefit
