#include "fsm/rig/rig.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <span>
#include <utility>

#include "fsm/base/spline.h"
#include "fsm/rig/deformation.h"
#include "fsm/rig/pose.h"
#include "fsm/rig/tongue_path.h"

namespace fsm {

/// One state on its way to vertices.
struct Rig::Frame {
  const FaceState& state;
  Pose pose;
  std::span<glm::vec3> position;
  std::span<glm::vec3> normal;  ///< none where only the mouth is measured
};

struct Rig::StepEntry {
  RigStep step;
  std::string_view name;
  void (Rig::*take)(Frame&) const;
};

constexpr Rig::StepEntry Rig::kSteps[] = {
    {RigStep::kChannels, "channels", &Rig::AddChannels},
    {RigStep::kDeformation, "deformation", &Rig::Deform},
    {RigStep::kLids, "lids", &Rig::TurnLids},
    {RigStep::kLidsOnBalls, "lids_on_balls", &Rig::KeepLidsOnBalls},
    {RigStep::kJaw, "jaw", &Rig::MoveWithJaw},
    {RigStep::kTeeth, "teeth", &Rig::KeepOffTeeth},
    {RigStep::kLips, "lips", &Rig::SealLips},
    {RigStep::kTongue, "tongue", &Rig::MoveTongue},
    {RigStep::kBones, "bones", &Rig::MoveBones},
    {RigStep::kNeck, "neck", &Rig::TurnNeck},
    {RigStep::kNormals, "normals", &Rig::FindNormals},
};

std::string_view NameOf(RigStep step) {
  constexpr std::string_view kNames[] = {"channels", "deformation", "lids",   "lids_on_balls",
                                         "jaw",      "teeth",       "lips",   "tongue",
                                         "bones",    "neck",        "normals"};
  return kNames[static_cast<std::size_t>(step)];
}

Rig::Rig(RigData data) : data_(std::move(data)) {
  std::vector<bool> soft(data_.rest.size(), false);
  for (const std::uint32_t i : data_.soft_triangles) soft[i] = true;
  for (std::uint32_t i = 0; i < data_.rest.size(); ++i) {
    if (data_.bone[i] != Bone::kSkin) {
      rigid_.push_back(i);
    } else if (data_.weights[i].jaw > 0.001f) {
      jawed_.push_back(i);
    }
    if (soft[i]) soft_.push_back(i);
  }
}

Pose Rig::PoseOf(const FaceState& state) const {
  Pose pose = MakePose(state, data_.units);
  pose.hinge = data_.jaw_hinge;
  return pose;
}

void Rig::TakeStep(RigStep step, Frame& frame) const {
  (this->*kSteps[static_cast<std::size_t>(step)].take)(frame);
}

void Rig::Evaluate(const FaceState& state, HeadVertices& out) const {
  out.position = data_.rest;
  out.normal = data_.rest_normal;
  Frame frame{state, PoseOf(state), out.position, out.normal};
  for (const RigStep step : data_.steps) TakeStep(step, frame);
  out.wrinkles = {};
  if (data_.creases) {
    out.wrinkles = CreaseDepths(frame.pose.units, *data_.creases);
    for (auto& sides : out.wrinkles) {
      for (float& depth : sides) depth *= data_.crease_depth;
    }
  }
  for (std::size_t side = 0; side < 2; ++side) out.lids_shut[side] = frame.pose.lids[side].close;
}

MouthMeasure Rig::MeasureMouth(const FaceState& state) const {
  if (!data_.lips.measured) return {};
  std::vector<glm::vec3> position = data_.rest;
  Frame frame{state, PoseOf(state), position, {}};
  for (const RigStep step : data_.steps) {
    if (step == RigStep::kTongue || step == RigStep::kBones) break;
    TakeStep(step, frame);
  }
  const auto [upper, lower, left, right] = *data_.lips.measured;
  return {.gap_mm = std::max(0.0f, position[upper].y - position[lower].y),
          .width_mm = glm::distance(position[left], position[right]),
          .jaw_degrees = glm::degrees(frame.pose.jaw.open_rad)};
}

Rig Rig::WithUnits(const UnitTable& units) const {
  RigData data = data_;
  data.units = units;
  if (data.person) data.units.MakeAsymmetric(*data.person);
  if (data.units_by_place) {
    std::erase_if(data.channels, [](const Channel& c) { return c.kind == Channel::Kind::kUnit; });
    std::ranges::move(UnitChannels(data.units, data.bone, data.weights),
                      std::back_inserter(data.channels));
  }
  if (data.deformation) {
    if (auto other = data.deformation->WithUnits(data.units)) data.deformation = std::move(other);
  }
  return Rig(std::move(data));
}

void Rig::AddChannels(Frame& frame) const {
  const Pose& pose = frame.pose;
  for (const Channel& channel : data_.channels) {
    const float weight = channel.kind == Channel::Kind::kUnit
                             ? pose.units[channel.side][channel.number]
                             : pose.mouth[channel.number];
    if (weight == 0) continue;
    for (const Displacement& d : channel.moves) frame.position[d.vertex] += weight * d.by;
  }
}

void Rig::Deform(Frame& frame) const {
  frame.pose.SetJaw(data_.deformation->Move(frame.state, frame.pose, frame.position));
}

void Rig::TurnLids(Frame& frame) const { MoveLids(data_.lids, frame.pose, frame.position); }

void Rig::KeepLidsOnBalls(Frame& frame) const {
  for (const BallLid& lid : data_.ball_lids) {
    glm::vec3& p = frame.position[lid.vertex];
    const glm::vec3 off = p - data_.ball_centre[lid.side];
    const float far = glm::length(off);
    if (far < lid.least && far > 1) p += off * (lid.least / far - 1);
  }
}

void Rig::MoveWithJaw(Frame& frame) const {
  const JawMove& jaw = frame.pose.jaw;
  if (jaw.open_rad == 0 && jaw.slide_mm == 0 && jaw.sway_mm == 0) return;
  for (const std::uint32_t i : jawed_) {
    frame.position[i] = TurnJaw(frame.position[i], frame.pose, data_.weights[i].jaw);
  }
}

void Rig::KeepOffTeeth(Frame& frame) const {
  // How much of a push counts, by height: all beside the crowns, fading past the edge.
  const auto beside = [](const ToothArch& arch, float y) {
    const float down = arch.root_y > arch.edge_y ? 1.0f : -1.0f;
    return SmoothStep(-2.2f, 0.2f, down * (y - arch.edge_y));
  };
  for (const TeethContact& contact : data_.teeth_contacts) {
    glm::vec3& p = frame.position[contact.vertex];
    const float upper = data_.upper_teeth.At(p.x) + contact.upper_gap - p.z;
    if (upper > 0) p.z += upper * beside(data_.upper_teeth, p.y);
    glm::vec3 q = IntoJaw(p, frame.pose);
    const float lower = data_.lower_teeth.At(q.x) + contact.lower_gap - q.z;
    if (lower > 0) {
      q.z += lower * beside(data_.lower_teeth, q.y);
      p = TurnJaw(q, frame.pose, 1);
    }
  }
}

void Rig::SealLips(Frame& frame) const { CloseLips(data_.lips, frame.pose.seal, frame.position); }

void Rig::MoveTongue(Frame& frame) const {
  constexpr float kRaise = 11;  // millimetres of the tip
  const Pose& pose = frame.pose;
  const TonguePath path(pose, data_.upper_teeth, data_.lower_teeth, data_.lips.seam,
                        frame.position);
  for (const std::uint32_t i : rigid_) {
    if (data_.bone[i] != Bone::kTongue) continue;
    const glm::vec3 rest = data_.rest[i], rest_normal = data_.rest_normal[i];
    const float tip = data_.weights[i].free;
    glm::vec3 p = rest;
    p.z += path.Part() * pose.tongue_out_mm * tip;
    p.y += pose.tongue_raise * kRaise * tip * tip;
    frame.position[i] = path.Fit(TurnJaw(p, pose, 1 - 0.25f * pose.tongue_raise * tip));
    frame.normal[i] = glm::normalize(TurnJaw(rest + rest_normal, pose, 1) - TurnJaw(rest, pose, 1));
  }
}

glm::mat3 Rig::EyeTurn(const Pose& pose, std::size_t side) const {
  if (!data_.look) return pose.eye[side];
  const Gaze gaze = GazeOf(pose.eye[side]);
  // To the viewer's right is outward of the agent's left eye.
  const bool outward = (gaze.right_deg > 0) == (side == 1);
  const auto turned = [](float angle, const LookRange& range) {
    return std::copysign(std::min(std::abs(angle) / range.gaze_deg, 1.0f) * range.turn, angle);
  };
  return EyeTo(
      {.right_deg = turned(gaze.right_deg, outward ? data_.look->outer : data_.look->inner),
       .up_deg = turned(gaze.up_deg, gaze.up_deg > 0 ? data_.look->up : data_.look->down)});
}

void Rig::MoveBones(Frame& frame) const {
  const std::array<glm::mat3, 2> eye{EyeTurn(frame.pose, 0), EyeTurn(frame.pose, 1)};
  for (const std::uint32_t i : rigid_) {
    glm::vec3& p = frame.position[i];
    glm::vec3& n = frame.normal[i];
    const Bone bone = data_.bone[i];
    if (bone == Bone::kJaw) {
      const glm::vec3 tip = TurnJaw(p + n, frame.pose, 1);
      p = TurnJaw(p, frame.pose, 1);
      n = glm::normalize(tip - p);
    } else if (bone == Bone::kEyeLeft || bone == Bone::kEyeRight) {
      const std::size_t side = bone == Bone::kEyeLeft ? 1 : 0;
      const glm::vec3 pivot = data_.eye_pivot[side];
      p = pivot + eye[side] * (p - pivot);
      n = eye[side] * n;
    }
  }
}

void Rig::TurnNeck(Frame& frame) const {
  for (std::size_t i = 0; i < frame.position.size(); ++i) {
    frame.position[i] = TurnHead(frame.position[i], frame.pose, data_.weights[i].neck);
  }
  for (const std::uint32_t i : rigid_) frame.normal[i] = frame.pose.head * frame.normal[i];
}

void Rig::FindNormals(Frame& frame) const {
  const auto owner = [this](std::uint32_t i) {
    return data_.normal_twin.empty() ? i : data_.normal_twin[i];
  };
  for (const std::uint32_t i : soft_) frame.normal[i] = glm::vec3(0);
  const std::vector<std::uint32_t>& t = data_.soft_triangles;
  for (std::size_t k = 0; k + 2 < t.size(); k += 3) {
    const glm::vec3 a = frame.position[t[k]];
    const glm::vec3 n = glm::cross(frame.position[t[k + 1]] - a, frame.position[t[k + 2]] - a);
    for (std::size_t c = 0; c < 3; ++c) frame.normal[owner(t[k + c])] += n;
  }
  for (const std::uint32_t i : soft_) {
    glm::vec3& n = frame.normal[i];
    const float squared = glm::dot(n, n);
    n = squared > 1e-12f ? n / std::sqrt(squared) : glm::vec3(0, 0, 1);
  }
  if (data_.normal_twin.empty()) return;
  for (const std::uint32_t i : soft_) frame.normal[i] = frame.normal[owner(i)];
}

}  // namespace fsm
