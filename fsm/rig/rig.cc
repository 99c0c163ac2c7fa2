#include "fsm/rig/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <utility>

#include "fsm/rig/step_constants.h"
#include "fsm/rig/tongue_path.h"

namespace fsm {
namespace {

// A twin is the same step for a graphics card, in fsm/render/shaders/rig_steps.glsl.

/// Skin goes with the jaw, by its weights. Twin: STEP_jaw.
void MoveWithJaw(std::span<const std::uint32_t> vertices, std::span<const SkinWeights> weights,
                 const Pose& pose, std::span<glm::vec3> position) {
  const JawMove& jaw = pose.jaw;
  if (jaw.open_rad == 0 && jaw.slide_mm == 0 && jaw.sway_mm == 0) return;
  for (const std::uint32_t i : vertices) position[i] = TurnJaw(position[i], pose, weights[i].jaw);
}

/// The jaw as far as the chin has gone, from `before` to `after`. Twin: STEP_jaw_by_chin.
JawMove ByChin(const JawRig& jaw, glm::vec3 before, glm::vec3 after) {
  before -= jaw.hinge;
  after -= jaw.hinge;
  const float angle = std::atan2(-after.y, after.z) - std::atan2(-before.y, before.z);
  return {.open_rad = std::clamp(angle, 0.0f, step::kMostOpen),
          .slide_mm = 0,
          .sway_mm = after.x - before.x};
}

/// Twin: STEP_own_form.
void AddOwnForm(std::span<const glm::vec3> to_own, std::span<glm::vec3> position) {
  for (std::size_t i = 0; i < to_own.size(); ++i) position[i] += to_own[i];
}

/// Twin: STEP_springs.
void Swing(std::span<const SpringWeight> weights, std::span<const glm::vec3> swings,
           std::span<glm::vec3> position) {
  if (swings.empty()) return;
  for (const auto& [vertex, spring, weight] : weights) {
    position[vertex] += weight * swings[spring];
  }
}

}  // namespace

/// What the steps read and write while they make vertices of a state.
struct Rig::Work {
  const FaceState& state;
  Pose pose;
  std::span<glm::vec3> position;
  std::span<glm::vec3> normal;  ///< empty where only steps that shape the skin are taken
  std::span<const glm::vec3> swings{};
};

std::string_view NameOf(RigStep step) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(RigStep::kNormals) + 1>
      kNames{"channels", "lids",   "lids_on_balls", "jaw",  "jaw_by_chin", "teeth",  "lips",
             "own_form", "tongue", "bones",         "neck", "springs",     "normals"};
  return kNames[static_cast<std::size_t>(step)];
}

void Rig::Take(RigStep step, Work& work) const {
  switch (step) {
    using enum RigStep;
    case kChannels:
      return AddChannels(work);
    case kLids:
      return MoveLids(data_.lids, work.pose, work.position);
    case kLidsOnBalls:
      return KeepOutside(data_.ball_lids, work.position);
    case kJaw:
      return MoveWithJaw(jawed_, data_.weights, work.pose, work.position);
    case kJawByChin: {
      const JawRig& jaw = data_.jaw;
      return work.pose.SetJaw(ByChin(jaw, data_.rest[jaw.chin], work.position[jaw.chin]));
    }
    case kTeeth:
      return KeepOffTeeth(data_.teeth, work.pose, work.position);
    case kLips:
      return CloseLips(data_.lips, work.pose.seal, work.position);
    case kOwnForm:
      return AddOwnForm(data_.proxy.to_own, work.position);
    case kTongue:
      return MoveTongue(work);
    case kBones:
      return MoveBones(work);
    case kNeck:
      return TurnNeck(work);
    case kSprings:
      return Swing(data_.swing.weights, work.swings, work.position);
    case kNormals:
      return FindNormals(data_.normals, soft_, work.position, work.normal);
  }
}

Rig::Rig(RigData data) : data_(std::move(data)), drives_(data_.channels) {
  std::vector<bool> soft(data_.rest.size(), false);
  for (const std::uint32_t i : data_.normals.soft_triangles) soft[i] = true;
  for (std::uint32_t i = 0; i < data_.rest.size(); ++i) {
    if (data_.bone[i] != Bone::kSkin) rigid_.push_back(i);
    if (MovesWithJaw(data_, i)) jawed_.push_back(i);
    if (soft[i]) soft_.push_back(i);
  }
}

Pose Rig::PoseOf(const FaceState& state) const {
  Pose pose = MakePose(state, data_.units);
  pose.hinge = data_.jaw.hinge;
  return pose;
}

void Rig::Evaluate(const FaceState& state, HeadVertices& out,
                   std::span<const glm::vec3> swings) const {
  out.position = data_.Start();
  out.normal = data_.rest_normal;
  Work work{state, PoseOf(state), out.position, out.normal, swings};
  for (const RigStep step : data_.steps) Take(step, work);
  FindCreasesAndLids(work.pose, out);
}

void Rig::FindCreasesAndLids(const Pose& pose, HeadVertices& out) const {
  out.creases = {};
  if (data_.creases.at_rest) {
    out.creases = CreaseDepths(pose.units, *data_.creases.at_rest);
    for (Sided<float>& depth : out.creases) {
      for (const Side side : kSides) depth[side] *= data_.creases.depth;
    }
  }
  for (const Side side : kSides) out.lids_shut[side] = pose.lids[side].close;
}

RigInputs Rig::InputsOf(const FaceState& state) const {
  RigInputs inputs{.pose = PoseOf(state), .strengths = {}, .eye_turn = {}};
  drives_.FindStrengths(data_.channels, state, inputs.pose, inputs.strengths);
  for (const Side side : kSides) inputs.eye_turn[side] = EyeTurn(inputs.pose, side);
  return inputs;
}

MouthMeasure Rig::MeasureMouth(const FaceState& state) const {
  if (!data_.lips.measured) return {};
  std::vector<glm::vec3> position = data_.Start();
  Work work{state, PoseOf(state), position, {}};
  for (const RigStep step : data_.steps) {
    if (!ShapesSkin(step)) break;  // the others write normals, and move no lips
    Take(step, work);
  }
  const auto [upper, lower, left, right] = *data_.lips.measured;
  return {.gap_mm = std::max(0.0f, position[upper].y - position[lower].y),
          .width_mm = glm::distance(position[left], position[right]),
          .jaw_degrees = glm::degrees(work.pose.jaw.open_rad)};
}

Rig Rig::WithUnits(const UnitTable& units) const {
  RigData data = data_;
  data.units = units;
  if (data.asymmetry_seed) data.units.MakeAsymmetric(*data.asymmetry_seed);
  if (data.units_by_place) {
    std::erase_if(data.channels,
                  [](const Channel& channel) { return channel.IsLedBy(Drive::Kind::kUnit); });
    std::ranges::move(UnitChannels(data.units, data.bone, data.weights),
                      std::back_inserter(data.channels));
  }
  return Rig(std::move(data));
}

/// Twin: STEP_channels.
void Rig::AddChannels(Work& work) const {
  thread_local std::vector<float> strengths;  // kept from frame to frame
  strengths.clear();
  drives_.FindStrengths(data_.channels, work.state, work.pose, strengths);
  for (std::size_t k = 0; k < strengths.size(); ++k) {
    if (strengths[k] == 0) continue;
    for (const Displacement& d : data_.channels[k].moves) {
      work.position[d.vertex] += strengths[k] * d.by;
    }
  }
}

/// Twin: STEP_tongue.
void Rig::MoveTongue(Work& work) const {
  const Pose& pose = work.pose;
  const TonguePath path(pose, data_.teeth.upper, data_.teeth.lower, data_.lips.seam, work.position);
  for (const std::uint32_t i : rigid_) {
    if (data_.bone[i] != Bone::kTongue) continue;
    const glm::vec3 rest = data_.rest[i], rest_normal = data_.rest_normal[i];
    const float tip = data_.weights[i].free;
    glm::vec3 p = rest;
    p.z += path.Share() * pose.tongue_out_mm * tip;
    p.y += pose.tongue_raise * step::kTongueRaise * tip * tip;
    work.position[i] =
        path.Fit(TurnJaw(p, pose, 1 - step::kTongueOffJaw * pose.tongue_raise * tip));
    work.normal[i] = glm::normalize(TurnJaw(rest + rest_normal, pose, 1) - TurnJaw(rest, pose, 1));
  }
}

glm::mat3 Rig::EyeTurn(const Pose& pose, Side side) const {
  const auto& ranges = data_.eyes.gaze_ranges;
  if (!ranges) return pose.eye[side];
  const EyeAngles gaze = GazeOf(pose.eye[side]);
  // To the viewer's right is outward of the agent's left eye.
  const bool outward = (gaze[kToRight] > 0) == (side == Side::kLeft);
  const auto turned = [](float angle, const GazeRange& range) {
    return std::copysign(std::min(std::abs(angle) / range.gaze_deg, 1.0f) * range.turn, angle);
  };
  return EyeTo({turned(gaze[kDown], gaze[kDown] < 0 ? ranges->up : ranges->down),
                turned(gaze[kToRight], outward ? ranges->outer : ranges->inner)});
}

/// Twin: STEP_bones.
void Rig::MoveBones(Work& work) const {
  const Sided<glm::mat3> turn{EyeTurn(work.pose, Side::kRight), EyeTurn(work.pose, Side::kLeft)};
  for (const std::uint32_t i : rigid_) {
    glm::vec3& p = work.position[i];
    glm::vec3& n = work.normal[i];
    const Bone bone = data_.bone[i];
    if (bone == Bone::kJaw) {
      const glm::vec3 tip = TurnJaw(p + n, work.pose, 1);
      p = TurnJaw(p, work.pose, 1);
      n = glm::normalize(tip - p);
    } else if (const auto eye = EyeOf(bone)) {
      const glm::vec3 pivot = data_.eyes.pivot[*eye];
      p = pivot + turn[*eye] * (p - pivot);
      n = turn[*eye] * n;
    }
  }
}

/// Twin: STEP_neck.
void Rig::TurnNeck(Work& work) const {
  for (std::size_t i = 0; i < work.position.size(); ++i) {
    work.position[i] = TurnHead(work.position[i], work.pose, data_.weights[i].neck);
  }
  for (const std::uint32_t i : rigid_) work.normal[i] = work.pose.head * work.normal[i];
}

}  // namespace fsm
