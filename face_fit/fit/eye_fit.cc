#include "face_fit/fit/eye_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "face_fit/fit/least_squares.h"

namespace facefit {
namespace {

fsm::EyeTransform FitEye(const BaseHead& base, const std::map<PointIndex, glm::vec3>& to,
                         fsm::Side side) {
  const auto outline = EyeOutline(side);
  const glm::vec3 centre = base.head->topology().eyes[side].centre;
  const auto place = [&](std::size_t k) { return base.AtRest(outline[k]); };
  const float inner = place(kInnerCorner).x, outer = place(kOuterCorner).x;
  // Unknown: shift x and y, size times cosine and sine of the turn, raise of upper and lower lid.
  LinearLeastSquares sum;
  float forward = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const glm::vec3 p = place(k) - centre;
    const glm::vec3 q = to.at(outline[k]) - centre;
    const float along = 2 * (place(k).x - inner) / (outer - inner) - 1;
    const double open = static_cast<double>(std::max(1 - along * along, 0.0F));
    const bool upper = k > 0 && k<kInnerCorner, lower = k> kInnerCorner;
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    sum.Add({1, 0, px, -py, 0, 0}, static_cast<double>(q.x));
    sum.Add({0, 1, py, px, upper ? open : 0, lower ? open : 0}, static_cast<double>(q.y));
    forward += (q.z - p.z) / static_cast<float>(outline.size());
  }
  const auto solved = sum.Solve(1e-6);
  const auto part = [&solved](std::size_t i) { return static_cast<float>(solved[i]); };
  fsm::EyeTransform transform;
  // What people's eyes do; beyond it a point was misjudged.
  transform.size = std::clamp(std::hypot(part(2), part(3)), 0.82F, 1.2F);
  transform.turn = std::clamp(std::atan2(part(3), part(2)), -0.25F, 0.25F);
  transform.shift = {part(0), part(1), forward};
  transform.upper_mm = std::clamp(part(4) / transform.size, -6.0F, 0.7F);
  transform.lower_mm = std::clamp(part(5) / transform.size, -2.5F, 3.5F);
  return transform;
}

}  // namespace

fsm::Sided<fsm::EyeTransform> FitEyes(const BaseHead& base,
                                      const std::map<PointIndex, glm::vec3>& to) {
  return {FitEye(base, to, fsm::Side::kRight), FitEye(base, to, fsm::Side::kLeft)};
}

namespace {

/// An eye's outline in the photo: corners and the middle between the lids.
struct Slit {
  glm::vec2 outer, inner, middle;
};
template <typename Place>
Slit SlitOf(fsm::Side side, Place place) {
  const auto outline = EyeOutline(side);
  // The lids' middles lie as far from the corner on either side.
  return {place(outline[kOuterCorner]), place(outline[kInnerCorner]),
          0.5F * (place(outline[kUpperMiddle]) + place(outline[kLowerMiddle]))};
}
Slit SlitOfBase(const BaseHead& base, fsm::Side side) {
  return SlitOf(side, [&base](PointIndex i) {
    const glm::vec3 p = base.AtRest(i);
    return glm::vec2(p.x, -p.y);
  });
}
/// Where the iris is expected, and the photo's pixels by millimetre of the base head's eye.
struct Expected {
  glm::vec2 centre;
  float scale;
};
Expected ExpectedIris(const BaseHead& base, const Slit& seen, fsm::Side side) {
  const Slit own = SlitOfBase(base, side);
  const glm::vec3 ball = base.head->topology().eyes[side].centre;
  const glm::vec2 from = own.inner - own.outer, to = seen.inner - seen.outer;
  const float scale = glm::length(to) / std::max(glm::length(from), 1e-3F);
  const float turn = std::atan2(to.y, to.x) - std::atan2(from.y, from.x);
  const glm::vec2 off = glm::vec2(ball.x, -ball.y) - own.middle;
  const float c = scale * std::cos(turn), s = scale * std::sin(turn);
  return {seen.middle + glm::vec2(c * off.x - s * off.y, s * off.x + c * off.y), scale};
}

}  // namespace

SeenIrises SeeIrises(const BaseHead& base, const FoundFace& face, const fsm::Image* photo) {
  SeenIrises irises;
  fsm::Sided<OpenEye> eyes;
  for (const fsm::Side side : fsm::kSides) {
    const auto place = [&face](PointIndex i) { return face.At(i); };
    const Expected iris = ExpectedIris(base, SlitOf(side, place), side);
    std::ranges::transform(EyeOutline(side), eyes[side].lids.begin(), place);
    eyes[side].middle = iris.centre;
    eyes[side].expected = iris.scale * base.head->topology().eyes[side].iris_radius;
    irises.rings[side] = {.centre = iris.centre, .radius = eyes[side].expected, .contrast = 0};
  }
  if (!photo) return irises;
  const auto rings = FindIrises(*photo, std::array{eyes.right, eyes.left});
  float size = 0, count = 0;
  for (const fsm::Side side : fsm::kSides) {
    const IrisRing& ring = rings[static_cast<std::size_t>(side)];
    if (ring.contrast < kClearRing) continue;
    irises.rings[side] = ring;
    size += ring.radius / eyes[side].expected;
    count += 1;
  }
  if (count > 0) irises.size = std::clamp(size / count, 0.8F, 1.12F);
  return irises;
}

void CentreEyes(const BaseHead& base, const SeenIrises& irises,
                std::vector<LandmarkConstraint>& constraints) {
  for (const fsm::Side side : fsm::kSides) {
    const IrisRing& ring = irises.rings[side];
    if (ring.contrast <= 0) continue;
    const auto outline = EyeOutline(side);
    const Slit slit = SlitOf(side, [&constraints](PointIndex i) {
      return std::ranges::find(constraints, i, &LandmarkConstraint::point)->pixel;
    });
    const Expected iris = ExpectedIris(base, slit, side);
    const glm::vec2 axis = glm::normalize(slit.inner - slit.outer);
    const glm::vec2 across(-axis.y, axis.x);
    const float off = glm::dot(ring.centre - iris.centre, across);
    const float free = 0.5F * iris.scale;  // eyes rest that differently in their slits
    const float by = std::clamp(off, -3 * iris.scale, 3 * iris.scale);
    if (std::abs(by) <= free) continue;
    for (LandmarkConstraint& constraint : constraints) {
      if (std::ranges::find(outline, constraint.point) == outline.end()) continue;
      constraint.pixel += (by - std::copysign(free, by)) * across;
    }
  }
}

}  // namespace facefit
