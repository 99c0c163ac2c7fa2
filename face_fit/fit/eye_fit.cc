#include "face_fit/fit/eye_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "face_fit/find/face/lid_lines.h"
#include "face_fit/fit/least_squares.h"
#include "face_fit/image/plane.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Plausible limits; sizes are relative to the built-in eye.
constexpr fsm::Range kSize{0.82F, 1.2F}, kRollRad{-0.25F, 0.25F}, kUpperRaiseMm{-6, 0.7F},
    kLowerRaiseMm{-2.5F, 3.5F};

fsm::EyeTransform FitEye(const ObservedHead& base, const std::map<PointIndex, glm::vec3>& to,
                         fsm::Side side) {
  const auto outline = point::kEyeOutline[side];
  assert(std::ranges::all_of(outline, [&](PointIndex i) { return to.contains(i); }));
  const glm::vec3 centre = base.head().EyeCentre(side);
  const auto at_rest = [&](std::size_t k) { return base.AtRest(outline[k]); };
  const float inner = at_rest(kInnerCorner).x, outer = at_rest(kOuterCorner).x;
  // Unknown: shift x and y, size times cosine and sine of the turn, raise of upper and lower lid.
  LinearLeastSquares sum;
  float forward = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const glm::vec3 p = at_rest(k) - centre;
    const glm::vec3 q = to.at(outline[k]) - centre;
    const double share = static_cast<double>(LidShare(at_rest(k).x, inner, outer));
    const bool upper = k > 0 && k < kInnerCorner;
    const bool lower = k > kInnerCorner;
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y);
    sum.Add({1, 0, px, -py, 0, 0}, static_cast<double>(q.x));
    sum.Add({0, 1, py, px, upper ? share : 0, lower ? share : 0}, static_cast<double>(q.y));
    forward += (q.z - p.z) / static_cast<float>(outline.size());
  }
  const auto solved = sum.Solve(1e-6);
  const auto unknown = [&solved](std::size_t i) { return static_cast<float>(solved[i]); };
  fsm::EyeTransform transform;
  transform.size = kSize.Clamp(std::hypot(unknown(2), unknown(3)));
  transform.roll = kRollRad.Clamp(std::atan2(unknown(3), unknown(2)));
  transform.shift = {unknown(0), unknown(1), forward};
  transform.upper_mm = kUpperRaiseMm.Clamp(unknown(4) / transform.size);
  transform.lower_mm = kLowerRaiseMm.Clamp(unknown(5) / transform.size);
  return transform;
}

}  // namespace

fsm::Sided<fsm::EyeTransform> FitEyes(const ObservedHead& base,
                                      const std::map<PointIndex, glm::vec3>& to) {
  return {FitEye(base, to, fsm::Side::kRight), FitEye(base, to, fsm::Side::kLeft)};
}

fsm::Sided<fsm::EyeTransform> EyesAtRest(const FittedHead& fitted) {
  const float kept = PhotoLook().squint_kept_share;
  const ObservedHead& base = *fitted.base;
  fsm::Sided<fsm::EyeTransform> transforms = fitted.eyes;
  for (const fsm::Side side : fsm::kSides) {
    const auto raised = [&](std::size_t k) {
      const MeshPoint& lid = base.mesh_points()[point::kEyeOutline[side][k]];
      return lid.On(fitted.base_in_expression).y - lid.On(base.rest().position).y;
    };
    transforms[side].upper_mm += kept * std::min(raised(kUpperMiddle), 0.0F);
    transforms[side].lower_mm += kept * std::max(raised(kLowerMiddle), 0.0F);
  }
  return transforms;
}

}  // namespace facefit
