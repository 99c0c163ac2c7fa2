#include "face_fit/fit/landmark_warp.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>

#include "face_fit/find/face/mouth_line.h"
#include "face_fit/fit/eye_fit.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"

namespace facefit {
namespace {

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

std::uint32_t NearestLip(const BaseHead& base, glm::vec3 p) {
  std::uint32_t nearest = 0;
  float distance = 1e9F;
  const auto& topology = base.head->topology();
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kLip) continue;
    for (const std::uint32_t v : topology.Corners(part)) {
      const float far = glm::distance(base.rest.position[v], p);
      if (far >= distance) continue;
      distance = far;
      nearest = v;
    }
  }
  return nearest;
}

/// Replaces the base head's skin in `posed_vertices` by the fitted head's in the photo's
/// expression.
void PoseSkin(FittedHead& fitted) {
  const auto skin = SkinWith(fitted, fitted.expression.State());
  std::ranges::copy(std::span(skin).first(std::min(skin.size(), fitted.posed_vertices.size())),
                    fitted.posed_vertices.begin());
}

/// Where the photo shows the point of a constraint.
glm::vec3 Seen(const CameraPose& pose, const LandmarkConstraint& constraint) {
  return pose.PlaceAt(constraint.pixel, constraint.z);
}

/// A point of the warp that goes where its constraint says, by their indices.
struct Correctable {
  std::size_t warp_point, constraint;
};

/// Sets the points of the warp by the constraints; `now`: the vertices with the expression.
std::vector<Correctable> PlaceWarpPoints(const PhotoTargets& targets,
                                         const std::vector<glm::vec3>& now, FittedHead& fitted) {
  const BaseHead& base = *fitted.base;
  std::vector<Correctable> correctable;
  fitted.points.clear();
  for (std::size_t i = 0; i < targets.constraints.size(); ++i) {
    const LandmarkConstraint& constraint = targets.constraints[i];
    // At rest both inner lips are one line, which cannot follow two that are apart in the photo.
    if (targets.lips_apart && OnInnerLips(constraint.point)) continue;
    const glm::vec3 rest = constraint.on_head.On(base.rest.position);
    if (const auto side = EyeOf(constraint)) {
      // Lids go with the eye: the skin around them must, too.
      const glm::vec3 centre = base.head->topology().eyes[*side].centre;
      fitted.points.push_back({rest, fitted.eyes[*side].Placed(centre, rest) - rest});
    } else {
      correctable.push_back({fitted.points.size(), i});
      fitted.points.push_back({rest, Seen(fitted.pose, constraint) - constraint.on_head.On(now)});
    }
  }
  return correctable;
}

}  // namespace

std::vector<glm::vec3> SkinWith(const FittedHead& fitted, const fsm::FaceState& state) {
  const BaseHead& base = *fitted.base;
  fsm::PhotoHead head;
  head.base = base.name;
  head.points = fitted.points;
  head.smooth = fitted.smooth;
  head.eyes = fitted.eyes;
  const fsm::Rig skin = fsm::MakeSkinRig(head);
  fsm::HeadVertices vertices;
  (base.units ? skin.WithUnits(*base.units) : skin).Evaluate(state, vertices);
  return vertices.position;
}

void ConstrainToMouthLine(const BaseHead& base, const FoundFace& face, const CameraPose& pose,
                          std::span<const glm::vec3> now, const fsm::Image& photo,
                          std::vector<LandmarkConstraint>& constraints) {
  const glm::vec3 right = base.head->Landmark("cheilion_right");
  const glm::vec3 left = base.head->Landmark("cheilion_left");
  const auto along = [&](const MeshPoint& p) {
    return (p.On(base.rest.position).x - right.x) / (left.x - right.x);
  };
  const auto line = FindMouthLine(photo, face, along(base.points[point::kMouthRight]),
                                  along(base.points[point::kMouthLeft]));
  std::erase_if(constraints, [](const auto& c) { return OnInnerLips(c.point); });
  const auto on_line = [&](float part) {
    const float at = glm::clamp(part, 0.0F, 1.0F) * (kMouthLinePoints - 1);
    const auto k = std::min(static_cast<std::size_t>(at), kMouthLinePoints - 2);
    return glm::mix(line[k], line[k + 1], at - static_cast<float>(k));
  };
  // Where the network misplaced a corner it misplaced the outer lips beside it, too.
  for (const PointIndex corner : {point::kMouthRight, point::kMouthLeft}) {
    const float corner_at = along(base.points[corner]);
    const glm::vec2 off = on_line(corner_at) - face.At(corner);
    for (LandmarkConstraint& constraint : constraints) {
      if (constraint.point != corner && !OfOuterLips(constraint)) continue;
      constraint.pixel +=
          off * glm::smoothstep(0.3F, 0.05F, std::abs(along(constraint.on_head) - corner_at));
    }
  }
  const auto constrain = [&](const MeshPoint& p) {
    constraints.push_back({kNoPoint, p, on_line(along(p)), pose.ToCamera(p.On(now)).z});
  };
  const std::span upper(point::kUpperInnerLip);
  for (const PointIndex i : upper.subspan(1, upper.size() - 2)) constrain(base.points[i]);
  for (const glm::vec3 corner : {right, left}) {
    const std::uint32_t v = NearestLip(base, corner);
    constrain({{v, v, v}, {1, 0, 0}});
  }
}

void WarpToLandmarks(const PhotoTargets& targets, FittedHead& fitted) {
  const BaseHead& base = *fitted.base;
  const std::vector<LandmarkConstraint>& constraints = targets.constraints;
  fsm::HeadVertices posed;
  base.head->Evaluate(fitted.expression.State(), posed);
  const std::vector<glm::vec3>& now = posed.position;
  std::map<PointIndex, glm::vec3> eyes;
  for (const LandmarkConstraint& constraint : constraints) {
    if (!EyeOf(constraint)) continue;
    eyes[constraint.point] =
        Seen(fitted.pose, constraint) -
        (constraint.on_head.On(now) - constraint.on_head.On(base.rest.position));
  }
  fitted.eyes = FitEyes(base, eyes);
  const std::vector<Correctable> correctable = PlaceWarpPoints(targets, now, fitted);
  const fsm::Warp warp(fitted.points, fitted.smooth);
  fitted.posed_vertices.clear();
  for (std::size_t i = 0; i < now.size(); ++i) {
    fitted.posed_vertices.push_back(now[i] + warp.Motion(base.rest.position[i]));
  }
  // What the head then makes of its units, lids and lips moves points a little off; once more with
  // that taken into account.
  PoseSkin(fitted);
  constexpr float kGain = 0.8F;
  for (const auto& [warp_point, of] : correctable) {
    const LandmarkConstraint& constraint = constraints[of];
    const glm::vec3 q = fitted.pose.ToCamera(constraint.on_head.On(fitted.posed_vertices));
    const glm::vec3 should = fitted.pose.PlaceAt(constraint.pixel, q.z);
    fitted.points[warp_point].by += kGain * (should - fitted.pose.FromCamera(q));
  }
  PoseSkin(fitted);
}

}  // namespace facefit
