#include "face_fit/fit/landmark_warp.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "face_fit/find/mouth_line.h"
#include "face_fit/find/rasterizer.h"
#include "face_fit/fit/eye_fit.h"
#include "fsm/base/spline.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"

namespace facefit {
namespace {

bool Among(std::span<const int> list, int point) {
  return std::ranges::find(list, point) != list.end();
}
bool OfInnerLips(int point) {
  return Among(UpperInnerLip(), point) || Among(LowerInnerLip(), point);
}
bool OfOuterLips(int point) {
  return Among(UpperOuterLip(), point) || Among(LowerOuterLip(), point);
}
int EyeOf(int point) {
  return Among(EyeOutline(0), point) ? 0 : Among(EyeOutline(1), point) ? 1 : -1;
}

std::uint32_t NearestLip(const BaseHead& base, glm::vec3 p) {
  std::uint32_t nearest = 0;
  const auto& topology = base.head->topology();
  const auto far = [&](std::uint32_t v) { return glm::distance(base.rest.position[v], p); };
  bool any = false;
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kLip) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      const std::uint32_t v = topology.indices[part.first_index + k];
      if (!any || far(v) < far(nearest)) nearest = v;
      any = true;
    }
  }
  return nearest;
}

/// The fitted head's skin in the photo's expression takes the place of the base head's in
/// `posed_vertices`.
void Wear(const BaseHead& base, Fit& fit) {
  const auto skin = SkinWith(base, fit, fit.expression.State());
  std::ranges::copy(std::span(skin).first(std::min(skin.size(), fit.posed_vertices.size())),
                    fit.posed_vertices.begin());
}

}  // namespace

std::vector<glm::vec3> SkinWith(const BaseHead& base, const Fit& fit, const fsm::FaceState& state) {
  fsm::PhotoHead set;
  set.base = base.name;
  set.points = fit.points;
  set.smooth = fit.smooth;
  set.eyes = fit.eyes;
  set.photo = std::make_shared<fsm::Image>(fsm::Image{1, 1, {0, 0, 0, 255}});
  const auto head = base.Moved(fsm::MakeHead(set));
  fsm::HeadVertices vertices;
  head->Evaluate(state, vertices);
  // Both begin with the same skin.
  std::uint32_t end = 0;
  ForSkinTriangles(head->topology(), [&end](const std::uint32_t* t) {
    end = std::max({end, t[0] + 1, t[1] + 1, t[2] + 1});
  });
  vertices.position.resize(end);
  return vertices.position;
}

void ConstrainToMouthLine(const BaseHead& base, const FoundFace& face, const CameraPose& pose,
                          std::span<const glm::vec3> now, const fsm::Image& photo,
                          std::vector<LandmarkConstraint>& constraints) {
  const glm::vec3 right = base.head->Landmark("cheilion_right");
  const glm::vec3 left = base.head->Landmark("cheilion_left");
  const auto along = [&](const MeshPlace& place) {
    return (place.On(base.rest.position).x - right.x) / (left.x - right.x);
  };
  const auto line = FindMouthLine(photo, face, along(base.places[61]), along(base.places[291]));
  std::erase_if(constraints,
                [](const LandmarkConstraint& constraint) { return OfInnerLips(constraint.point); });
  const auto on_line = [&](float part) {
    const float at = glm::clamp(part, 0.0F, 1.0F) * (kMouthLinePlaces - 1);
    const auto k = std::min(static_cast<std::size_t>(at), kMouthLinePlaces - 2);
    return glm::mix(line[k], line[k + 1], at - static_cast<float>(k));
  };
  // Where the network misplaced a corner it misplaced the outer lips beside it, too.
  for (const int corner : {61, 291}) {
    const auto c = static_cast<std::size_t>(corner);
    const float corner_at = along(base.places[c]);
    const glm::vec2 off = on_line(corner_at) - face.At(c);
    for (LandmarkConstraint& constraint : constraints) {
      if (constraint.point != corner && !OfOuterLips(constraint.point)) continue;
      constraint.pixel +=
          off * fsm::SmoothStep(0.3F, 0.05F, std::abs(along(constraint.place) - corner_at));
    }
  }
  const auto constrain = [&](const MeshPlace& place) {
    constraints.push_back({-1, place, on_line(along(place)), pose.ToCamera(place.On(now)).z});
  };
  for (const int point : UpperInnerLip()) {
    if (point != 78 && point != 308) constrain(base.places[static_cast<std::size_t>(point)]);
  }
  for (const glm::vec3 corner : {right, left}) {
    const std::uint32_t v = NearestLip(base, corner);
    constrain({{v, v, v}, {1, 0, 0}});
  }
}

void WarpToLandmarks(const BaseHead& base, Fit& fit) {
  const std::vector<LandmarkConstraint>& constraints = fit.constraints;
  fsm::HeadVertices posed;
  base.head->Evaluate(fit.expression.State(), posed);
  const std::vector<glm::vec3>& now = posed.position;
  const auto lies = [&](const LandmarkConstraint& constraint) {
    return fit.pose.FromCamera(fit.pose.Unproject(constraint.pixel, constraint.z));
  };
  std::map<int, glm::vec3> eyes;
  for (const LandmarkConstraint& constraint : constraints) {
    if (EyeOf(constraint.point) < 0) continue;
    eyes[constraint.point] =
        lies(constraint) - (constraint.place.On(now) - constraint.place.On(base.rest.position));
  }
  fit.eyes = FitEyes(base, eyes);
  const auto& seats = base.head->topology().eyes;
  fit.points.clear();
  std::vector<std::size_t> bent;  // constraints of fit.points that may be corrected
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const LandmarkConstraint& constraint = constraints[i];
    // At rest both inner lips are one line, which cannot follow two that are apart in the photo.
    if (fit.lips_apart && OfInnerLips(constraint.point)) continue;
    const glm::vec3 rest = constraint.place.On(base.rest.position);
    const int eye = EyeOf(constraint.point);
    if (eye < 0) {
      bent.push_back(fit.points.size());
      of.push_back(i);
      fit.points.push_back({rest, lies(constraint) - constraint.place.On(now)});
    } else {
      // Lids go with the eye: the skin around them must, too.
      const auto side = static_cast<std::size_t>(eye);
      const fsm::EyeTransform& seat = fit.eyes[side];
      fit.points.push_back({rest, seat.Placed(seats[side].centre, rest) - rest});
    }
  }
  const fsm::Warp warp(fit.points, fit.smooth);
  fit.posed_vertices.clear();
  for (std::size_t i = 0; i < now.size(); ++i) {
    fit.posed_vertices.push_back(now[i] + warp.Motion(base.rest.position[i]));
  }
  // What the head then makes of its units, lids and lips moves places a little off; once more with
  // that taken into account.
  Wear(base, fit);
  constexpr float kGain = 0.8F;
  for (std::size_t k = 0; k < bent.size(); ++k) {
    const LandmarkConstraint& constraint = constraints[of[k]];
    const glm::vec3 q = fit.pose.ToCamera(constraint.place.On(fit.posed_vertices));
    const glm::vec3 should = fit.pose.FromCamera(fit.pose.Unproject(constraint.pixel, q.z));
    fit.points[bent[k]].by += kGain * (should - fit.pose.FromCamera(q));
  }
  Wear(base, fit);
}

}  // namespace facefit
