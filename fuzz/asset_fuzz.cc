// The file of a small head with bytes changed: what is read moves, is measured and takes other
// units without harm, the rest is refused. Input: changes of five bytes each: where (three bytes,
// wrapped round), one that is not used, and what stands there then. No changes: the whole file.

#include <chrono>
#include <cstdint>
#include <string>

#include "fsm/asset/asset_reader.h"
#include "fsm/asset/asset_writer.h"
#include "fsm/asset/describe.h"
#include "fsm/rig/simulation.h"
#include "tests/support/still_rig.h"

namespace {

/// Some vertices, and one element of everything that an asset can have.
fsm::Head SmallHead() {
  constexpr std::uint32_t kVertices = 12;
  fsm::HeadAsset asset;
  std::vector<glm::vec3> rest, normal;
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    const auto t = static_cast<float>(i);
    rest.emplace_back(10 * t - 50, t * t - 60, 80 - t);
    normal.emplace_back(0, 0, 1);
  }
  fsm::RigData& rig = asset.rig = support::MakeStillRig(std::move(rest), std::move(normal));
  rig.steps.clear();
  for (int step = 0; step <= static_cast<int>(fsm::RigStep::kNormals); ++step)
    rig.steps.push_back(static_cast<fsm::RigStep>(step));
  rig.weights.resize(kVertices);
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    rig.bone[i] = static_cast<fsm::Bone>(i % 6);
    rig.weights[i].jaw = 0.1F * static_cast<float>(i);
  }
  rig.normals.soft_triangles = {0, 1, 2, 3, 4, 5};
  rig.units = fsm::UnitTable(fsm::Table("units", "field 4 10 20 15 15 both 1 2 3\nclose 43 1"));
  rig.units_by_place = true;
  using Kind = fsm::Drive::Kind;
  for (int kind = 0; kind <= static_cast<int>(Kind::kResidual); ++kind) {
    fsm::Channel& channel = rig.channels.emplace_back();
    channel.drivers = {{{static_cast<Kind>(kind), 0, fsm::Drive::WhichSide::kStronger}, 0.5F}};
    channel.max = 2;
    channel.moves = {{2, {1, 2, 3}}};
  }
  rig.proxy.rest.resize(kVertices);
  rig.proxy.to_own.resize(kVertices);
  rig.lids.vertices = {{1, fsm::Side::kRight, {1, 0, 0.2F, -0.2F, -0.1F, 1, 12, 2}, true}};
  rig.ball_lids = {{1, fsm::Side::kLeft, 12}};
  rig.mouth = {.seam = {{2, 3}}, .corners = {{4, 1}}, .incisors = {{2, 3, 4}}};
  rig.lips.apart_at_rest = {{0, 0.1F, 0}};
  rig.lips.followers = {{4, 0, 0.5F}};
  rig.teeth.upper = rig.teeth.lower = {70, 20, 25, -40, -30, 0, 0};
  rig.teeth.contacts = {{4, 1, 1}};
  rig.eyes.pivot.emplace();
  rig.eyes.gaze_ranges.emplace();
  rig.spring_rig.springs.resize(1);
  rig.spring_rig.weights = {{8, 0, 0.5F}};
  rig.creases.at_rest = {{0, 0.1F, 0, 0}};
  asset.surface.indices = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  asset.surface.parts = {{fsm::Material::kSkin, 0, 6}, {fsm::Material::kHair, 6, 3, 0, true}};
  asset.surface.albedo.resize(kVertices);
  asset.surface.openness.resize(kVertices);
  asset.surface.strands.resize(kVertices);
  asset.surface.opacity.assign(kVertices, 0.5F);
  asset.surface.portrait.shut_lids.resize(1);
  asset.surface.skin_strokes.resize(2);
  asset.surface.pbr_materials.resize(1);
  asset.surface.textures.base_colour = std::make_shared<fsm::Image>(fsm::Image{1, 1, {1, 2, 3, 4}});
  asset.surface.textures.texcoord.resize(kVertices);
  asset.surface.textures.weight.resize(kVertices);
  asset.surface.portrait.eyes.emplace();
  asset.landmarks["nasion"] = {0, 20, 90};
  asset.view.emplace();
  return fsm::Head(std::move(asset));
}

/// The face at rest, with everything at its most, and with everything beyond that.
std::vector<fsm::FaceState> States() {
  std::vector<fsm::FaceState> states(1);
  for (const float strength : {1.0F, -1.0F, 1e30F}) {
    fsm::FaceState& state = states.emplace_back();
    for (std::size_t unit = 0; unit < fsm::kActionUnits; ++unit) {
      state.au.left[unit] = strength;
      state.au.right[unit] = 2 * strength;
    }
    state.au.left[fsm::UnitValues::kMax] = strength;
    state.mouth.fill(10 * strength);
    state.mouth_by_hand.fill(-10 * strength);
    state.seal = state.tongue = strength;
    state.blink = {strength, strength};
    state.gaze.left = state.gaze.right = {30 * strength, 40 * strength};
    state.head_rotation = {50 * strength, 70 * strength, 45 * strength};
    state.head_forward_mm = 40 * strength;
  }
  return states;
}

void Move(const fsm::Head& head) {
  fsm::HeadVertices vertices;
  for (const fsm::FaceState& state : States()) {
    head.Evaluate(state, vertices);
    head.MeasureMouth(state);
    fsm::Simulation simulation(head.rig().data().spring_rig.springs);
    for (const int ms : {0, 500, 530}) {
      simulation.RunTo(std::chrono::milliseconds(ms), [&state](auto) { return state; });
    }
    head.Evaluate(state, vertices, simulation.offsets());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string kWhole = fsm::WriteAsset(SmallHead(), {});
  std::string file = kWhole;
  for (; size >= 5; data += 5, size -= 5) {
    const auto at = static_cast<std::size_t>(data[0] | data[1] << 8 | data[2] << 16);
    file[at % file.size()] = static_cast<char>(data[4]);
  }
  auto asset = fsm::ParseAsset("head.glb", file);
  if (!asset) return 0;
  const fsm::Head head(std::move(*asset));
  Move(head);
  static const fsm::UnitTable kOthers(
      fsm::Table("others", "field 12 10 20 15 15 both 1 2 3\njaw 26 20 0"));
  Move(*head.WithUnits(kOthers));
  fsm::Describe(head);
  return 0;
}
