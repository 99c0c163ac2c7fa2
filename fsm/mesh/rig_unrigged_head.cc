#include "fsm/mesh/rig_unrigged_head.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "fsm/base/smooth_step.h"
#include "fsm/head/face_channels.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/mouth_parts.h"
#include "fsm/rig/normals.h"

namespace fsm {
namespace {

HeadSurface SurfaceOf(const UnriggedHead& model) {
  HeadSurface surface;
  SetParts(model.mesh.batches, surface);
  if (surface.indices.empty()) throw std::runtime_error("the head has no triangles");
  surface.albedo = model.mesh.albedo;
  surface.openness.assign(model.mesh.position.size(), 1);
  for (const glm::vec3& p : model.mesh.position) surface.uv.push_back(SkinUv(p));
  surface.textures = model.textures;
  surface.pbr_materials = model.pbr_materials;
  surface.eyes = model.eyes;
  return surface;
}

/// Returns the skin near the eyeballs that is outside them at rest, and must remain so.
std::vector<BallLid> LidsOf(const UnriggedHead& model) {
  constexpr float kReach = 8, kThickness = 0.6f;
  std::vector<BallLid> lids;
  for (std::uint32_t i = 0; i < model.mesh.position.size(); ++i) {
    if (model.mesh.bone[i] != Bone::kSkin) continue;
    for (const Side side : kSides) {
      const float radius = model.eyes[side].ball_radius;
      const glm::vec3 centre = model.eye_rig.centre[side];
      const float distance = glm::distance(model.mesh.position[i], centre);
      if (distance < radius - 0.5f || distance > radius + kReach) continue;
      if (model.mesh.position[i].z < centre.z) continue;
      lids.push_back({i, side, std::min(distance, radius + kThickness)});
    }
  }
  return lids;
}

/// Returns for each vertex the one that it shares its normal with: vertices at the same position
/// that face the same way, so that texture seams are not visible in the shading.
std::vector<std::uint32_t> NormalTwins(const std::vector<glm::vec3>& position,
                                       const std::vector<glm::vec3>& normal) {
  std::vector<std::uint32_t> order(position.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t i) {
    const glm::vec3 p = position[i];
    return std::tuple(p.x, p.y, p.z, i);
  });
  std::vector<std::uint32_t> twin(order.size());
  std::iota(twin.begin(), twin.end(), 0U);
  constexpr float kFacesTheSameWay = 0.5f;  // cosine
  // The vertices at one position that are not twins of others there. They face different ways, so
  // there are few; in a damaged file with more, the rest have no twins.
  constexpr std::size_t kMaxWays = 64;
  std::vector<std::uint32_t> firsts;
  for (const std::uint32_t one : order) {
    if (!firsts.empty() && position[firsts.front()] != position[one]) firsts.clear();
    const auto same_way = [&](std::uint32_t other) {
      return glm::dot(normal[one], normal[other]) >= kFacesTheSameWay;
    };
    const auto found = std::ranges::find_if(firsts.rbegin(), firsts.rend(), same_way);
    if (found != firsts.rend()) {
      twin[one] = *found;
    } else if (firsts.size() < kMaxWays) {
      firsts.push_back(one);
    }
  }
  return twin;
}

RigData RigOf(const UnriggedHead& model, const HeadSurface& surface, RigData rig) {
  using enum RigStep;
  for (const RigStep step : {kLidsOnBalls, kBones, kNeck, kSprings, kNormals})
    rig.steps.push_back(step);
  rig.rest = model.mesh.position;
  rig.rest_normal = Normals(surface.indices, rig.rest, rig.rest.size());
  rig.bone = model.mesh.bone;
  rig.weights.resize(rig.rest.size());
  for (std::size_t i = 0; i < rig.rest.size(); ++i) {
    rig.weights[i].neck = model.mesh.weights[i].skin.neck;
    if (rig.bone[i] == Bone::kTongue) rig.bone[i] = Bone::kJaw;
  }
  rig.normals.soft_triangles = surface.indices;
  if (!surface.pbr_materials.empty()) rig.normals.twin = NormalTwins(rig.rest, rig.rest_normal);
  rig.jaw.hinge = model.jaw_hinge;
  rig.eyes = model.eye_rig;
  rig.mouth = model.mouth;
  rig.spring_rig = model.spring_rig;
  if (model.has_eyes && model.round_eyes) rig.ball_lids = LidsOf(model);
  return rig;
}

/// Finds the teeth, which have the mouth lit by what enters between the lips. Less light reaches
/// the sides and the lower teeth.
void LightMouth(RigData& rig, HeadSurface& surface) {
  if (rig.mouth.seam.empty() || !rig.mouth.corners) return;
  rig.mouth.incisors = FindIncisors(rig.rest, rig.bone, surface);
  if (!rig.mouth.incisors) return;
  const Features& features = *Features::BuiltIn();
  const glm::vec3 shade = features.lower_teeth_colour;
  const float middle = rig.rest[rig.mouth.incisors->upper].x;
  std::vector<bool> taken(rig.rest.size(), false);
  for (const HeadSurface::Part& part : surface.parts) {
    const bool teeth = part.material == Material::kTeeth;
    if (!teeth && part.material != Material::kGum && part.material != Material::kTongue) continue;
    for (const std::uint32_t i : surface.Corners(part)) {
      if (taken[i]) continue;
      taken[i] = true;
      const bool lower = rig.bone[i] == Bone::kJaw;
      if (teeth && lower) surface.albedo[i] *= shade;
      surface.openness[i] =
          glm::mix(teeth && lower ? features.teeth_light.lower : features.teeth_light.upper,
                   features.teeth_light.deep, SmoothStep(6, 32, std::abs(rig.rest[i].x - middle)));
    }
  }
}

}  // namespace

RigData MakeStillSkin() {
  RigData rig;
  rig.units = BuiltInUnits();
  return rig;
}

std::unique_ptr<Head> RigUnriggedHead(UnriggedHead model, RigData skin) {
  HeadAsset asset{.surface = SurfaceOf(model), .rig = {}, .landmarks = {}, .view = model.view};
  asset.rig = RigOf(model, asset.surface, std::move(skin));
  if (!model.textures.base_colour) LightMouth(asset.rig, asset.surface);
  asset.landmarks = std::move(model.landmarks);
  return std::make_unique<Head>(std::move(asset));
}

}  // namespace fsm
