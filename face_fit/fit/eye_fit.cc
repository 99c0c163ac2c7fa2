#include "face_fit/fit/eye_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "face_fit/fit/least_squares.h"
#include "face_fit/picture/plane.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Plausible limits. Sizes are relative to the built-in eye, the turn in radians, the raise of the
// lids in millimetres.
constexpr glm::vec2 kSize{0.82F, 1.2F}, kTurn{-0.25F, 0.25F}, kUpperRaise{-6, 0.7F},
    kLowerRaise{-2.5F, 3.5F}, kIrisSize{0.8F, 1.12F};
/// How far an iris may lie above or below the middle between the lids: so differently do eyes rest;
/// and by how much the lids are moved at most.
constexpr float kFreeRestMm = 0.5F, kMaxShiftMm = 3;

float Within(glm::vec2 range, float v) { return std::clamp(v, range.x, range.y); }

fsm::EyeTransform FitEye(const ObservedHead& base, const std::map<PointIndex, glm::vec3>& to,
                         fsm::Side side) {
  const auto outline = EyeOutline(side);
  const glm::vec3 centre = base.head().topology().eyes[side].centre;
  const auto place = [&](std::size_t k) { return base.AtRest(outline[k]); };
  const float inner = place(kInnerCorner).x, outer = place(kOuterCorner).x;
  // Unknown: shift x and y, size times cosine and sine of the turn, raise of upper and lower lid.
  LinearLeastSquares sum;
  float forward = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const glm::vec3 p = place(k) - centre;
    const glm::vec3 q = to.at(outline[k]) - centre;
    const double open = static_cast<double>(LidOpening(place(k).x, inner, outer));
    const bool upper = k > 0 && k < kInnerCorner;
    const bool lower = k > kInnerCorner;
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    sum.Add({1, 0, px, -py, 0, 0}, static_cast<double>(q.x));
    sum.Add({0, 1, py, px, upper ? open : 0, lower ? open : 0}, static_cast<double>(q.y));
    forward += (q.z - p.z) / static_cast<float>(outline.size());
  }
  const auto solved = sum.Solve(1e-6);
  const auto part = [&solved](std::size_t i) { return static_cast<float>(solved[i]); };
  fsm::EyeTransform transform;
  transform.size = Within(kSize, std::hypot(part(2), part(3)));
  transform.turn = Within(kTurn, std::atan2(part(3), part(2)));
  transform.shift = {part(0), part(1), forward};
  transform.upper_mm = Within(kUpperRaise, part(4) / transform.size);
  transform.lower_mm = Within(kLowerRaise, part(5) / transform.size);
  return transform;
}

/// An eye's outline in the photo: corners and the middle between the lids.
struct LidSpan {
  glm::vec2 outer, inner, middle;
};
template <typename Place>
LidSpan LidSpanOf(fsm::Side side, Place place) {
  const auto outline = EyeOutline(side);
  // The lids' middles lie as far from the corner on either side.
  return {place(outline[kOuterCorner]), place(outline[kInnerCorner]),
          0.5F * (place(outline[kUpperMiddle]) + place(outline[kLowerMiddle]))};
}
/// Where the iris is expected; millimetres are those of the base head's eye.
struct IrisPlacement {
  glm::vec2 centre;
  float pixels_per_mm;
};
IrisPlacement ExpectedIris(const ObservedHead& base, const LidSpan& photo, fsm::Side side) {
  const LidSpan own = LidSpanOf(
      side, [&base](PointIndex i) { return glm::vec2(1, -1) * glm::vec2(base.AtRest(i)); });
  const glm::vec3 ball = base.head().topology().eyes[side].centre;
  const glm::vec2 from = own.inner - own.outer, to = photo.inner - photo.outer;
  const float pixels_per_mm = glm::length(to) / std::max(glm::length(from), 1e-3F);
  const float turn_rad = std::atan2(to.y, to.x) - std::atan2(from.y, from.x);
  const glm::vec2 from_middle = glm::vec2(ball.x, -ball.y) - own.middle;
  return {photo.middle + pixels_per_mm * Rotated(from_middle, turn_rad), pixels_per_mm};
}

}  // namespace

fsm::Sided<fsm::EyeTransform> FitEyes(const ObservedHead& base,
                                      const std::map<PointIndex, glm::vec3>& to) {
  return {FitEye(base, to, fsm::Side::kRight), FitEye(base, to, fsm::Side::kLeft)};
}

PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image* photo) {
  PhotoIrises irises;
  fsm::Sided<OpenEye> eyes;
  for (const fsm::Side side : fsm::kSides) {
    const auto place = [&face](PointIndex i) { return face.PixelOf(i); };
    const IrisPlacement iris = ExpectedIris(base, LidSpanOf(side, place), side);
    std::ranges::transform(EyeOutline(side), eyes[side].lids.begin(), place);
    eyes[side].middle = iris.centre;
    eyes[side].expected_radius = iris.pixels_per_mm * base.head().topology().eyes[side].iris_radius;
    irises.circles[side] = {
        .centre = iris.centre, .radius = eyes[side].expected_radius, .contrast = 0};
  }
  if (!photo) return irises;
  const auto found = FindIrises(*photo, std::array{eyes.right, eyes.left});
  float size = 0, count = 0;
  for (const fsm::Side side : fsm::kSides) {
    const IrisCircle& iris = found[static_cast<std::size_t>(side)];
    if (iris.contrast < kClearIris) continue;
    irises.circles[side] = iris;
    size += iris.radius / eyes[side].expected_radius;
    count += 1;
  }
  if (count > 0) irises.size = Within(kIrisSize, size / count);
  return irises;
}

std::vector<LandmarkConstraint> ShiftLidsToIrises(const ObservedHead& base,
                                                  const PhotoIrises& irises,
                                                  std::vector<LandmarkConstraint> constraints) {
  for (const fsm::Side side : fsm::kSides) {
    const IrisCircle& iris = irises.circles[side];
    if (iris.contrast <= 0) continue;
    const LidSpan span = LidSpanOf(side, [&constraints](PointIndex i) {
      return std::ranges::find(constraints, i, &LandmarkConstraint::point)->pixel;
    });
    const IrisPlacement expected = ExpectedIris(base, span, side);
    const glm::vec2 axis = glm::normalize(span.inner - span.outer);
    const glm::vec2 across(-axis.y, axis.x);
    const float free_px = kFreeRestMm * expected.pixels_per_mm;
    const float max_px = kMaxShiftMm * expected.pixels_per_mm;
    const float shift_px =
        std::clamp(glm::dot(iris.centre - expected.centre, across), -max_px, max_px);
    if (std::abs(shift_px) <= free_px) continue;
    for (LandmarkConstraint& constraint : constraints) {
      if (!Contains(EyeOutline(side), constraint.point)) continue;
      constraint.pixel += (shift_px - std::copysign(free_px, shift_px)) * across;
    }
  }
  return constraints;
}

fsm::Sided<fsm::EyeTransform> EyesAtRest(const FittedHead& fitted) {
  const float kept = PhotoLook().squint_kept_part;
  const ObservedHead& base = *fitted.base;
  fsm::HeadVertices posed;
  base.head().Evaluate(fitted.expression.State(), posed);
  fsm::Sided<fsm::EyeTransform> transforms = fitted.eyes;
  for (const fsm::Side side : fsm::kSides) {
    const auto raised = [&](std::size_t k) {
      const MeshPoint& lid = base.places()[EyeOutline(side)[k]];
      return lid.On(posed.position).y - lid.On(base.rest().position).y;
    };
    transforms[side].upper_mm += kept * std::min(raised(kUpperMiddle), 0.0F);
    transforms[side].lower_mm += kept * std::max(raised(kLowerMiddle), 0.0F);
  }
  return transforms;
}

}  // namespace facefit
