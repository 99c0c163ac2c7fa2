#include "face_fit/fit/pixel_warp.h"

#include <algorithm>
#include <cassert>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <utility>

#include "face_fit/fit/eye_fit.h"
#include "fsm/head/make_head.h"

namespace facefit {
namespace {

/// Share of the remaining way that points of the warp are moved in the second pass. The whole way
/// would overshoot, because neighbouring points move as well.
constexpr float kCorrectionGain = 0.8F;

/// Returns the eye whose outline has the point; none if no eye's has.
std::optional<fsm::Side> EyeOf(const PixelConstraint& c) {
  for (const fsm::Side side : fsm::kSides) {
    if (c.IsAmong(point::kEyeOutline[side])) return side;
  }
  return std::nullopt;
}

/// Replaces the skin among the vertices by that which fsm will show in the photo's expression.
void UpdateSkin(FittedHead& fitted) {
  const auto skin = SkinWith(fitted, fitted.expression.State());
  assert(skin.size() <= fitted.vertices.size());
  std::ranges::copy(skin, fitted.vertices.begin());
}

/// Returns where the photo shows the point of a constraint, head's frame.
glm::vec3 TargetOf(const CameraPose& pose, const PixelConstraint& constraint) {
  return pose.PositionOf(constraint.pixel, constraint.z_mm);
}

/// A point of the warp and the constraint it follows, by their indices.
struct Correctable {
  std::size_t warp_point, constraint;
};

struct WarpPoints {
  std::vector<fsm::WarpPoint> points;
  std::vector<Correctable> correctable;
};
/// Returns the points of the warp that the constraints ask for. `base_in_expression`: as
/// FittedHead's.
WarpPoints MakeWarpPoints(const ObservedHead& base, const CameraPose& pose,
                          std::span<const PixelConstraint> constraints,
                          const fsm::Sided<fsm::EyeTransform>& eyes,
                          const std::vector<glm::vec3>& base_in_expression) {
  WarpPoints made;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const PixelConstraint& constraint = constraints[i];
    const glm::vec3 rest = constraint.on_head.On(base.rest().position);
    if (const auto side = EyeOf(constraint)) {
      // Lids move with the eye, and the skin around them must follow.
      const glm::vec3 centre = base.head().EyeCentre(*side);
      made.points.push_back({rest, eyes[*side].PointInFace(centre, rest) - rest});
    } else {
      made.correctable.push_back({made.points.size(), i});
      made.points.push_back(
          {rest, TargetOf(pose, constraint) - constraint.on_head.On(base_in_expression)});
    }
  }
  return made;
}

/// Returns the eyes that the constraints show; `base_in_expression`: as FittedHead's.
fsm::Sided<fsm::EyeTransform> FitEyesTo(const ObservedHead& base, const CameraPose& pose,
                                        std::span<const PixelConstraint> constraints,
                                        const std::vector<glm::vec3>& base_in_expression) {
  std::map<PointIndex, glm::vec3> outlines;
  for (const PixelConstraint& constraint : constraints) {
    if (!EyeOf(constraint)) continue;
    outlines[*constraint.point] =
        TargetOf(pose, constraint) -
        (constraint.on_head.On(base_in_expression) - constraint.on_head.On(base.rest().position));
  }
  return FitEyes(base, outlines);
}

}  // namespace

fsm::PhotoHead PhotoHeadOf(const FittedHead& fitted) {
  fsm::PhotoHead head;
  head.base = fitted.base->name();
  head.points = fitted.warp_points;
  head.smooth = kWarpSmoothMm;
  head.eyes = fitted.eyes;
  return head;
}

std::vector<glm::vec3> SkinWith(const FittedHead& fitted, const fsm::FaceState& state) {
  const ObservedHead& base = *fitted.base;
  const fsm::Rig skin = fsm::MakeSkinRig(PhotoHeadOf(fitted));
  fsm::HeadVertices vertices;
  (base.units() ? skin.WithUnits(*base.units()) : skin).Evaluate(state, vertices);
  return vertices.position;
}

FittedHead WarpToPixels(const ObservedHead& base, const CameraPose& pose,
                        const Expression& expression, std::vector<glm::vec3> base_in_expression,
                        std::span<const PixelConstraint> constraints) {
  const auto eyes = FitEyesTo(base, pose, constraints, base_in_expression);
  WarpPoints made = MakeWarpPoints(base, pose, constraints, eyes, base_in_expression);
  FittedHead fitted{.base = &base,
                    .pose = pose,
                    .expression = expression,
                    .warp_points = std::move(made.points),
                    .eyes = eyes,
                    .base_in_expression = std::move(base_in_expression),
                    .vertices = {}};
  const fsm::Warp warp(fitted.warp_points, kWarpSmoothMm);
  for (std::size_t i = 0; i < fitted.base_in_expression.size(); ++i) {
    fitted.vertices.push_back(fitted.base_in_expression[i] + warp.Motion(base.rest().position[i]));
  }
  // The warped head's own units, lids and lips move points slightly off; a second pass corrects
  // that.
  UpdateSkin(fitted);
  for (const auto& [warp_point, of] : made.correctable) {
    const PixelConstraint& constraint = constraints[of];
    const glm::vec3 q = pose.ToCamera(constraint.on_head.On(fitted.vertices));
    const glm::vec3 target = pose.PositionOf(constraint.pixel, q.z);
    fitted.warp_points[warp_point].displacement += kCorrectionGain * (target - pose.FromCamera(q));
  }
  UpdateSkin(fitted);
  return fitted;
}

}  // namespace facefit
