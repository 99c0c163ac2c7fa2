#include "fsm/rig/rig.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <utility>

namespace fsm {
namespace {

/// Returns the rotation of an eyeball: the gaze angles, mapped by GazeRanges if there are any.
glm::mat3 EyeRotation(const EyeRig& eyes, const Pose& pose, Side side) {
  const auto& ranges = eyes.gaze_ranges;
  if (!ranges) return pose.eye[side];
  const EyeAngles gaze = GazeOf(pose.eye[side]);
  // A gaze to the viewer's right is outward for the agent's left eye.
  const bool outward = (gaze[kToRight] > 0) == (side == Side::kLeft);
  const auto mapped = [](float angle, const GazeRange& range) {
    return std::copysign(std::min(std::abs(angle) / range.gaze_deg, 1.0f) * range.output, angle);
  };
  return EyeRotationOf({mapped(gaze[kDown], gaze[kDown] < 0 ? ranges->up : ranges->down),
                        mapped(gaze[kToRight], outward ? ranges->outer : ranges->inner)});
}

step::Eye EyeInState(const RigData& data, const Pose& pose, Side side) {
  const EyeTransform& eye = data.lids.eyes[side];
  const UnitEffects::Lids& lids = pose.lids[side];
  const glm::vec3 across = eye.Rotated({0, 1, 0});  // (-sin, cos) times the eye's size
  const glm::vec3 ahead = pose.eye[side][2];
  return {
      .gaze = step::RotationOf(EyeRotation(data.eyes, pose, side)),
      .pivot = step::PointAt(data.eyes.pivot.value_or(data.eyes.centre)[side]),
      .ball = step::PointAt(data.eyes.centre[side]),
      .cornea = step::PointAt(data.lids.ball[side] + eye.size * data.lids.cornea_centre * ahead),
      .size = eye.size,
      .tilt_cosine = across.y,
      .tilt_sine = -across.x,
      .upper_open = eye.upper_mm + lids.upper_mm,
      .lower_open = eye.lower_mm,
      .lower_raised = lids.lower_mm,
      .close = lids.close};
}

step::StepState StateOf(const RigData& data, const Pose& pose) {
  const auto& [open, slide, sway] = pose.jaw;
  return {.mouth = {.jaw = step::JawAt(open, slide, sway, data.jaw.hinge.y, data.jaw.hinge.z),
                    .upper = data.teeth.upper,
                    .lower = data.teeth.lower,
                    .seal = pose.seal,
                    .tongue_raise = pose.tongue_raise,
                    .tongue_out = pose.tongue_out_mm},
          .eyes = {EyeInState(data, pose, Side::kRight), EyeInState(data, pose, Side::kLeft)},
          .neck = {.rotation = step::RotationOf(pose.head),
                   .pivot = step::PointAt(kNeckPivot),
                   .forward = pose.head_forward_mm}};
}

}  // namespace

Rig::Rig(RigData data)
    : data_(std::move(data)),
      combiner_(data_.units, data_.asymmetry_seed),
      moved_(data_),
      drives_(data_.channels) {}

void Rig::Evaluate(const FaceState& state, HeadVertices& out,
                   std::span<const glm::vec3> spring_offsets) const {
  thread_local RigInputs inputs;  // kept from frame to frame
  ComputeInputs(state, inputs);
  out.position = data_.StartPositions();
  out.normal = data_.rest_normal;
  StepWork work{inputs.state, inputs.strengths, spring_offsets, out.position, out.normal};
  for (const RigStep step : data_.steps) DefinitionOf(step).apply(data_, moved_, work);
  ComputeCreasesAndLids(inputs.pose, out);
}

void Rig::ComputeCreasesAndLids(const Pose& pose, HeadVertices& out) const {
  out.creases = {};
  if (data_.creases.at_rest) {
    out.creases = CreaseDepths(data_.units, pose.au, *data_.creases.at_rest);
    for (Sided<float>& depth : out.creases) {
      for (const Side side : kSides) depth[side] *= data_.creases.depth;
    }
  }
  for (const Side side : kSides) out.lids_shut[side] = pose.lids[side].close;
}

void Rig::ComputeInputs(const FaceState& state, RigInputs& inputs) const {
  inputs.pose = MakePose(state, data_.units, combiner_);
  inputs.state = StateOf(data_, inputs.pose);
  inputs.strengths.clear();
  drives_.ComputeStrengths(data_.channels, state, inputs.pose, inputs.strengths);
}

MouthMeasure Rig::MeasureMouth(const FaceState& state) const {
  if (data_.mouth.seam.empty() || !data_.mouth.corners) return {};
  RigInputs inputs;
  ComputeInputs(state, inputs);
  std::vector<glm::vec3> position = data_.StartPositions();
  StepWork work{inputs.state, inputs.strengths, {}, position, {}};
  for (const RigStep step : data_.steps) {
    if (!ShapesSkin(step)) break;  // the later steps do not change the mouth's shape
    DefinitionOf(step).apply(data_, moved_, work);
  }
  const auto [upper, lower] = data_.mouth.Middle();
  const auto [right, left] = *data_.mouth.corners;
  return {.gap_mm = std::max(0.0f, position[upper].y - position[lower].y),
          .width_mm = glm::distance(position[left], position[right]),
          .jaw_degrees = glm::degrees(work.state.mouth.jaw.open)};
}

Rig Rig::WithUnits(const UnitTable& units) const {
  RigData data = data_;
  data.units = units;
  if (data.has_unit_channels) {
    std::erase_if(data.channels,
                  [](const Channel& channel) { return channel.IsLedBy(Drive::Kind::kUnit); });
    std::ranges::move(UnitChannels(data.units, data.bone, data.weights),
                      std::back_inserter(data.channels));
  }
  return Rig(std::move(data));
}

}  // namespace fsm
