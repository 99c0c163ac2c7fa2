#include "fsm/mesh/mesh_head.h"

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

HeadTopology TopologyOf(const MeshModel& model) {
  HeadTopology topology;
  SetParts(model.mesh.batches, topology);
  if (topology.indices.empty()) throw std::runtime_error("the head has no triangles");
  topology.albedo = model.mesh.albedo;
  topology.openness.assign(model.mesh.position.size(), 1);
  for (const glm::vec3& p : model.mesh.position) topology.uv.push_back(Unroll(p));
  topology.textures = model.textures;
  topology.pbr_materials = model.pbr_materials;
  topology.eyes = model.eyes;
  return topology;
}

/// Returns the skin near the eyeballs that is outside them at rest, and must remain so.
std::vector<BallLids::Vertex> LidsOf(const MeshModel& model) {
  constexpr float kReach = 8, kThickness = 0.6F;
  std::vector<BallLids::Vertex> lids;
  for (std::uint32_t i = 0; i < model.mesh.position.size(); ++i) {
    if (model.mesh.bone[i] != Bone::kSkin) continue;
    for (const Side side : kSides) {
      const EyeGeometry& eye = model.eyes[side];
      const float far = glm::distance(model.mesh.position[i], eye.centre);
      if (far < eye.ball_radius - 0.5F || far > eye.ball_radius + kReach) continue;
      if (model.mesh.position[i].z < eye.centre.z) continue;
      lids.push_back({i, side, std::min(far, eye.ball_radius + kThickness)});
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
  constexpr float kFacesTheSameWay = 0.5F;  // cosine
  // The vertices at one position that are not twins of others there. They face different ways, so
  // there are few; in a damaged file with more, the rest have no twins.
  constexpr std::size_t kMostWays = 64;
  std::vector<std::uint32_t> firsts;
  for (const std::uint32_t one : order) {
    if (!firsts.empty() && position[firsts.front()] != position[one]) firsts.clear();
    const auto same_way = [&](std::uint32_t other) {
      return glm::dot(normal[one], normal[other]) >= kFacesTheSameWay;
    };
    const auto found = std::ranges::find_if(firsts.rbegin(), firsts.rend(), same_way);
    if (found != firsts.rend()) {
      twin[one] = *found;
    } else if (firsts.size() < kMostWays) {
      firsts.push_back(one);
    }
  }
  return twin;
}

RigData RigOf(const MeshModel& model, const HeadTopology& topology, RigData rig) {
  using enum RigStep;
  for (const RigStep step : {kLidsOnBalls, kBones, kNeck, kSprings, kNormals})
    rig.steps.push_back(step);
  rig.rest = model.mesh.position;
  rig.rest_normal = Normals(topology.indices, rig.rest, rig.rest.size());
  rig.bone = model.mesh.bone;
  rig.weights.resize(rig.rest.size());
  for (std::size_t i = 0; i < rig.rest.size(); ++i) {
    rig.weights[i].neck = model.mesh.weights[i].skin.neck;
    if (rig.bone[i] == Bone::kTongue) rig.bone[i] = Bone::kJaw;
  }
  rig.normals.soft_triangles = topology.indices;
  if (!topology.pbr_materials.empty()) rig.normals.twin = NormalTwins(rig.rest, rig.rest_normal);
  rig.jaw.hinge = model.jaw_hinge;
  for (const Side side : kSides) {
    rig.ball_lids.centre[side] = model.eyes[side].centre;
    rig.eyes.pivot[side] =
        model.eye_setup.pivot ? (*model.eye_setup.pivot)[side] : rig.ball_lids.centre[side];
  }
  rig.eyes.gaze_ranges = model.eye_setup.gaze_ranges;
  rig.spring_rig = model.spring_rig;
  if (model.has_eyes && model.round_eyes) rig.ball_lids.vertices = LidsOf(model);
  if (!rig.lips.measured && !model.seam.empty()) {
    const auto [upper, lower] = model.seam[model.seam.size() / 2];
    rig.lips.measured = {upper, lower, model.seam.back().first, model.seam.front().first};
  }
  return rig;
}

/// Sets what is needed to light the mouth, which light enters between the lips: their gap, and the
/// teeth behind it. Less light reaches the sides and the lower teeth.
void FindMouth(const RigData& rig, HeadTopology& topology) {
  if (!rig.lips.measured || rig.lips.seam.empty()) return;
  FindIncisors(rig.rest, rig.bone, topology);
  MouthSlit& mouth = topology.mouth;
  if (mouth.upper_incisor == mouth.lower_incisor) {  // no teeth
    mouth = {};
    return;
  }
  mouth.seam = rig.lips.seam;
  mouth.corner_left = (*rig.lips.measured)[LipRig::kCornerLeft];
  mouth.corner_right = (*rig.lips.measured)[LipRig::kCornerRight];
  const Features& features = Features::BuiltIn();
  const glm::vec3 shade = features.lower_teeth_colour;
  const float middle = rig.rest[mouth.upper_incisor].x;
  std::vector<bool> taken(rig.rest.size(), false);
  for (const HeadTopology::Part& part : topology.parts) {
    const bool teeth = part.material == Material::kTeeth;
    if (!teeth && part.material != Material::kGum && part.material != Material::kTongue) continue;
    for (const std::uint32_t i : topology.Corners(part)) {
      if (taken[i]) continue;
      taken[i] = true;
      const bool lower = rig.bone[i] == Bone::kJaw;
      if (teeth && lower) topology.albedo[i] *= shade;
      topology.openness[i] =
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

std::unique_ptr<Head> MakeMeshHead(MeshModel model, RigData skin) {
  HeadAsset asset{.topology = TopologyOf(model), .rig = {}, .landmarks = {}, .view = model.view};
  asset.rig = RigOf(model, asset.topology, std::move(skin));
  if (model.seam.empty() && !model.textures.image) FindMouth(asset.rig, asset.topology);
  asset.landmarks = std::move(model.landmarks);
  return std::make_unique<Head>(std::move(asset));
}

}  // namespace fsm
