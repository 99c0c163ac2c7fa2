#include "face_fit/fit/landmark_warp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <utility>

#include "face_fit/find/face/mouth_line.h"
#include "face_fit/fit/eye_fit.h"
#include "face_fit/tables/photo_look.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"

namespace facefit {
namespace {

/// How far from a corner of the mouth, by the mouth's width, the outer lips no longer go with it,
/// and up to where they go all the way.
constexpr glm::vec2 kGoesWithCorner{0.3F, 0.05F};
/// What part of the way to its target a point of the warp is moved the second time: all of it would
/// overshoot, because its neighbours move as well.
constexpr float kCorrectionGain = 0.8F;

bool OfOuterLips(const LandmarkConstraint& c) {
  return Contains(point::kUpperOuterLip, c.point) || Contains(point::kLowerOuterLip, c.point);
}
/// Whose outline has the point; none if it is no eye's.
std::optional<fsm::Side> EyeOf(const LandmarkConstraint& c) {
  for (const fsm::Side side : fsm::kSides) {
    if (Contains(EyeOutline(side), c.point)) return side;
  }
  return std::nullopt;
}

std::uint32_t NearestLip(const ObservedHead& base, glm::vec3 p) {
  std::uint32_t nearest = 0;
  float distance = 1e9F;
  const auto& topology = base.head().topology();
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kLip) continue;
    for (const std::uint32_t v : topology.Corners(part)) {
      const float other = glm::distance(base.rest().position[v], p);
      if (other >= distance) continue;
      distance = other;
      nearest = v;
    }
  }
  return nearest;
}

/// The posed vertices with the base head's skin replaced by the fitted head's in the photo's
/// expression.
std::vector<glm::vec3> PosedSkin(const FittedHead& fitted) {
  const auto skin = SkinWith(fitted, fitted.expression.State());
  std::vector<glm::vec3> posed = fitted.posed_vertices;
  assert(skin.size() <= posed.size());
  std::ranges::copy(skin, posed.begin());
  return posed;
}

/// Where the photo shows the point of a constraint.
glm::vec3 TargetOf(const CameraPose& pose, const LandmarkConstraint& constraint) {
  return pose.PlaceAt(constraint.pixel, constraint.z_mm);
}

/// A point of the warp that goes where its constraint says, by their indices.
struct Correctable {
  std::size_t warp_point, constraint;
};

struct WarpPoints {
  std::vector<fsm::WarpPoint> points;
  std::vector<Correctable> correctable;
};
/// The points of the warp as the constraints say; `now`: the vertices with the expression.
WarpPoints PlaceWarpPoints(const ObservedHead& base, const CameraPose& pose,
                           const PhotoTargets& targets, const fsm::Sided<fsm::EyeTransform>& eyes,
                           const std::vector<glm::vec3>& now) {
  WarpPoints placed;
  for (std::size_t i = 0; i < targets.constraints.size(); ++i) {
    const LandmarkConstraint& constraint = targets.constraints[i];
    // At rest both inner lips are one line, which cannot follow two that are apart in the photo.
    if (targets.lips_apart && OnInnerLips(constraint.point)) continue;
    const glm::vec3 rest = constraint.on_head.On(base.rest().position);
    if (const auto side = EyeOf(constraint)) {
      // Lids go with the eye: the skin around them must, too.
      const glm::vec3 centre = base.head().topology().eyes[*side].centre;
      placed.points.push_back({rest, eyes[*side].Placed(centre, rest) - rest});
    } else {
      placed.correctable.push_back({placed.points.size(), i});
      placed.points.push_back({rest, TargetOf(pose, constraint) - constraint.on_head.On(now)});
    }
  }
  return placed;
}

/// The eyes that the constraints show; `now`: as of PlaceWarpPoints.
fsm::Sided<fsm::EyeTransform> EyesOf(const ObservedHead& base, const CameraPose& pose,
                                     const PhotoTargets& targets,
                                     const std::vector<glm::vec3>& now) {
  std::map<PointIndex, glm::vec3> outlines;
  for (const LandmarkConstraint& constraint : targets.constraints) {
    if (!EyeOf(constraint)) continue;
    outlines[constraint.point] =
        TargetOf(pose, constraint) -
        (constraint.on_head.On(now) - constraint.on_head.On(base.rest().position));
  }
  return FitEyes(base, outlines);
}

}  // namespace

std::vector<glm::vec3> SkinWith(const FittedHead& fitted, const fsm::FaceState& state) {
  const ObservedHead& base = *fitted.base;
  fsm::PhotoHead head;
  head.base = base.name();
  head.points = fitted.warp_points;
  head.smooth = fitted.smooth_mm;
  head.eyes = fitted.eyes;
  const fsm::Rig skin = fsm::MakeSkinRig(head);
  fsm::HeadVertices vertices;
  (base.units() ? skin.WithUnits(*base.units()) : skin).Evaluate(state, vertices);
  return vertices.position;
}

std::vector<LandmarkConstraint> ConstrainToMouthLine(const ObservedHead& base,
                                                     const FoundFace& face, const CameraPose& pose,
                                                     std::span<const glm::vec3> now,
                                                     const fsm::Image& photo,
                                                     std::vector<LandmarkConstraint> constraints) {
  const glm::vec3 right = base.head().Landmark("cheilion_right");
  const glm::vec3 left = base.head().Landmark("cheilion_left");
  const auto along = [&](const MeshPoint& p) {
    return (p.On(base.rest().position).x - right.x) / (left.x - right.x);
  };
  const auto line = FindMouthLine(photo, face, along(base.places()[point::kMouthRight]),
                                  along(base.places()[point::kMouthLeft]));
  std::erase_if(constraints, [](const auto& c) { return OnInnerLips(c.point); });
  const auto on_line = [&](float part) {
    const float step = glm::clamp(part, 0.0F, 1.0F) * (kMouthLinePoints - 1);
    const auto k = std::min(static_cast<std::size_t>(step), kMouthLinePoints - 2);
    return glm::mix(line[k], line[k + 1], step - static_cast<float>(k));
  };
  // Where the network misplaced a corner it misplaced the outer lips beside it, too.
  for (const PointIndex corner : {point::kMouthRight, point::kMouthLeft}) {
    const float corner_part = along(base.places()[corner]);
    const glm::vec2 shift_px = on_line(corner_part) - face.PixelOf(corner);
    for (LandmarkConstraint& constraint : constraints) {
      if (constraint.point != corner && !OfOuterLips(constraint)) continue;
      constraint.pixel +=
          shift_px *
          fsm::SmoothStep(kGoesWithCorner, std::abs(along(constraint.on_head) - corner_part));
    }
  }
  const auto constrain = [&](const MeshPoint& p) {
    constraints.push_back({kNoPoint, p, on_line(along(p)), pose.ToCamera(p.On(now)).z});
  };
  const std::span upper(point::kUpperInnerLip);
  for (const PointIndex i : upper.subspan(1, upper.size() - 2)) constrain(base.places()[i]);
  for (const glm::vec3 corner : {right, left}) {
    const std::uint32_t v = NearestLip(base, corner);
    constrain({{v, v, v}, {1, 0, 0}});
  }
  return constraints;
}

FittedHead WarpToLandmarks(const ObservedHead& base, const CameraPose& pose,
                           const Expression& expression, const PhotoTargets& targets) {
  fsm::HeadVertices posed;
  base.head().Evaluate(expression.State(), posed);
  const std::vector<glm::vec3>& now = posed.position;
  const auto eyes = EyesOf(base, pose, targets, now);
  WarpPoints placed = PlaceWarpPoints(base, pose, targets, eyes, now);
  FittedHead fitted{.base = &base,
                    .pose = pose,
                    .expression = expression,
                    .warp_points = std::move(placed.points),
                    .eyes = eyes,
                    .posed_vertices = now};
  const fsm::Warp warp(fitted.warp_points, fitted.smooth_mm);
  for (std::size_t i = 0; i < now.size(); ++i) {
    fitted.posed_vertices[i] += warp.Motion(base.rest().position[i]);
  }
  // What the head then makes of its units, lids and lips moves points a little off; once more with
  // that taken into account.
  fitted.posed_vertices = PosedSkin(fitted);
  for (const auto& [warp_point, of] : placed.correctable) {
    const LandmarkConstraint& constraint = targets.constraints[of];
    const glm::vec3 q = pose.ToCamera(constraint.on_head.On(fitted.posed_vertices));
    const glm::vec3 target = pose.PlaceAt(constraint.pixel, q.z);
    fitted.warp_points[warp_point].by += kCorrectionGain * (target - pose.FromCamera(q));
  }
  fitted.posed_vertices = PosedSkin(fitted);
  return fitted;
}

}  // namespace facefit
