#include "fsm/rig/rig.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "fsm/base/spline.h"
#include "fsm/rig/step_constants.h"
#include "fsm/rig/tongue_path.h"

namespace fsm {

/// One state on its way to vertices.
struct Rig::Frame {
  const FaceState& state;
  Pose pose;
  std::span<glm::vec3> position;
  std::span<glm::vec3> normal;  ///< none where only the mouth is measured
  std::span<const glm::vec3> swings{};
};

struct Rig::StepEntry {
  RigStep step;
  std::string_view name;
  void (Rig::*take)(Frame&) const;
};

constexpr Rig::StepEntry Rig::kSteps[] = {
    {RigStep::kChannels, "channels", &Rig::AddChannels},
    {RigStep::kLids, "lids", &Rig::TurnLids},
    {RigStep::kLidsOnBalls, "lids_on_balls", &Rig::KeepLidsOnBalls},
    {RigStep::kJaw, "jaw", &Rig::MoveWithJaw},
    {RigStep::kJawByChin, "jaw_by_chin", &Rig::FollowChin},
    {RigStep::kTeeth, "teeth", &Rig::KeepOffTeeth},
    {RigStep::kLips, "lips", &Rig::SealLips},
    {RigStep::kOwnForm, "own_form", &Rig::TakeOwnForm},
    {RigStep::kTongue, "tongue", &Rig::MoveTongue},
    {RigStep::kBones, "bones", &Rig::MoveBones},
    {RigStep::kNeck, "neck", &Rig::TurnNeck},
    {RigStep::kSprings, "springs", &Rig::Swing},
    {RigStep::kNormals, "normals", &Rig::FindNormals},
};

std::string_view NameOf(RigStep step) {
  constexpr std::string_view kNames[] = {
      "channels", "lids",   "lids_on_balls", "jaw",  "jaw_by_chin", "teeth",  "lips",
      "own_form", "tongue", "bones",         "neck", "springs",     "normals"};
  return kNames[static_cast<std::size_t>(step)];
}

Rig::Rig(RigData data) : data_(std::move(data)) {
  std::vector<bool> soft(data_.rest.size(), false);
  for (const std::uint32_t i : data_.soft_triangles) soft[i] = true;
  for (std::uint32_t i = 0; i < data_.rest.size(); ++i) {
    if (data_.bone[i] != Bone::kSkin) rigid_.push_back(i);
    if (MovesWithJaw(data_, i)) jawed_.push_back(i);
    if (soft[i]) soft_.push_back(i);
  }
  FindDrives();
}

void Rig::FindDrives() {
  std::map<std::array<int, 4>, std::uint32_t> known;
  for (const Channel& channel : data_.channels) {
    for (const auto& [drive, gain] : channel.drivers) {
      const std::array key{static_cast<int>(drive.kind), static_cast<int>(drive.number),
                           static_cast<int>(drive.side), static_cast<int>(drive.half)};
      const auto [at, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(drives_.size()));
      if (fresh) drives_.push_back(drive);
      driver_from_.push_back(at->second);
    }
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

void Rig::Evaluate(const FaceState& state, HeadVertices& out,
                   std::span<const glm::vec3> swings) const {
  out.position = data_.proxy_rest.empty() ? data_.rest : data_.proxy_rest;
  out.normal = data_.rest_normal;
  Frame frame{state, PoseOf(state), out.position, out.normal, swings};
  for (const RigStep step : data_.steps) TakeStep(step, frame);
  FindMarks(frame.pose, out);
}

void Rig::FindMarks(const Pose& pose, HeadVertices& out) const {
  out.creases = {};
  if (data_.creases) {
    out.creases = CreaseDepths(pose.units, *data_.creases);
    for (Sided<float>& depth : out.creases) {
      for (const Side side : kSides) depth[side] *= data_.crease_depth;
    }
  }
  for (const Side side : kSides) out.lids_shut[side] = pose.lids[side].close;
}

RigInputs Rig::InputsOf(const FaceState& state) const {
  RigInputs inputs{.pose = PoseOf(state), .strengths = {}, .eye_turn = {}};
  FindStrengths(state, inputs.pose, inputs.strengths);
  for (const Side side : kSides) inputs.eye_turn[side] = EyeTurn(inputs.pose, side);
  return inputs;
}

MouthMeasure Rig::MeasureMouth(const FaceState& state) const {
  if (!data_.lips.measured) return {};
  std::vector<glm::vec3> position = data_.proxy_rest.empty() ? data_.rest : data_.proxy_rest;
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
    std::erase_if(data.channels, [](const Channel& channel) {
      return channel.drivers.front().drive.kind == Drive::Kind::kUnit;
    });
    std::ranges::move(UnitChannels(data.units, data.bone, data.weights),
                      std::back_inserter(data.channels));
  }
  return Rig(std::move(data));
}

float Rig::ValueOf(const Drive& drive, const FaceState& state, const Pose& pose) {
  using enum Drive::Kind;
  const std::size_t number = drive.number;
  constexpr float kMostMouth = 30;  // millimetres, of the jaw degrees
  const auto whole = [&](Side side) {
    switch (drive.kind) {
      case kUnit:
        return pose.units[side][number];
      case kAskedUnit:
        return Bound(state.au[side][number], 0, 2);
      case kMouth:
        return pose.mouth[number];
      case kSpokenMouth:
        return Bound(state.mouth[number] - state.mouth_by_hand[number], -kMostMouth, kMostMouth);
      case kHandMouth:
        return Bound(state.mouth_by_hand[number], -kMostMouth, kMostMouth);
      case kBlink:
        return pose.blink[side];
      case kGazeUp:
        return -GazeOf(pose.eye[side])[kDown];
      case kGazeRight:
        return GazeOf(pose.eye[side])[kToRight];
    }
    return 0.0f;
  };
  const auto value = [&](Side side) {
    if (drive.half == Drive::Half::kWhole) return whole(side);
    return std::max(drive.half == Drive::Half::kPositive ? whole(side) : -whole(side), 0.0f);
  };
  if (drive.side == Drive::WhichSide::kStronger) {
    return std::max(value(Side::kRight), value(Side::kLeft));
  }
  return value(drive.side == Drive::WhichSide::kRight ? Side::kRight : Side::kLeft);
}

void Rig::FindStrengths(const FaceState& state, const Pose& pose, std::vector<float>& out) const {
  thread_local std::vector<float> values;  // of the drives; kept from frame to frame
  values.clear();
  for (const Drive& drive : drives_) values.push_back(ValueOf(drive, state, pose));
  auto from = driver_from_.begin();
  for (const Channel& channel : data_.channels) {
    float strength = 0;
    for (const Channel::Driver& driver : channel.drivers) strength += driver.gain * values[*from++];
    out.push_back(std::clamp(strength, channel.least, channel.most) *
                  ((1 - pose.seal) * channel.open_factor + pose.seal * channel.sealed_factor));
  }
}

void Rig::AddChannels(Frame& frame) const {
  thread_local std::vector<float> strengths;  // kept from frame to frame
  strengths.clear();
  FindStrengths(frame.state, frame.pose, strengths);
  for (std::size_t k = 0; k < strengths.size(); ++k) {
    if (strengths[k] == 0) continue;
    for (const Displacement& d : data_.channels[k].moves) {
      frame.position[d.vertex] += strengths[k] * d.by;
    }
  }
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

void Rig::FollowChin(Frame& frame) const {
  const glm::vec3 before = data_.rest[data_.chin] - data_.jaw_hinge;
  const glm::vec3 after = frame.position[data_.chin] - data_.jaw_hinge;
  const float angle = std::atan2(-after.y, after.z) - std::atan2(-before.y, before.z);
  frame.pose.SetJaw({.open_rad = std::clamp(angle, 0.0f, step::kMostOpen),
                     .slide_mm = 0,
                     .sway_mm = after.x - before.x});
}

void Rig::KeepOffTeeth(Frame& frame) const {
  // How much of a push counts, by height: all beside the crowns, fading past the edge.
  const auto beside = [](const ToothArch& arch, float y) {
    const float down = arch.root_y > arch.edge_y ? 1.0f : -1.0f;
    return SmoothStep(step::kPastTeeth, step::kBesideTeeth, down * (y - arch.edge_y));
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

void Rig::TakeOwnForm(Frame& frame) const {
  for (std::size_t i = 0; i < frame.position.size(); ++i) {
    frame.position[i] += data_.own_form[i];
  }
}

void Rig::MoveTongue(Frame& frame) const {
  const Pose& pose = frame.pose;
  const TonguePath path(pose, data_.upper_teeth, data_.lower_teeth, data_.lips.seam,
                        frame.position);
  for (const std::uint32_t i : rigid_) {
    if (data_.bone[i] != Bone::kTongue) continue;
    const glm::vec3 rest = data_.rest[i], rest_normal = data_.rest_normal[i];
    const float tip = data_.weights[i].free;
    glm::vec3 p = rest;
    p.z += path.Part() * pose.tongue_out_mm * tip;
    p.y += pose.tongue_raise * step::kTongueRaise * tip * tip;
    frame.position[i] =
        path.Fit(TurnJaw(p, pose, 1 - step::kTongueOffJaw * pose.tongue_raise * tip));
    frame.normal[i] = glm::normalize(TurnJaw(rest + rest_normal, pose, 1) - TurnJaw(rest, pose, 1));
  }
}

glm::mat3 Rig::EyeTurn(const Pose& pose, Side side) const {
  if (!data_.look) return pose.eye[side];
  const EyeAngles gaze = GazeOf(pose.eye[side]);
  // To the viewer's right is outward of the agent's left eye.
  const bool outward = (gaze[kToRight] > 0) == (side == Side::kLeft);
  const auto turned = [](float angle, const LookRange& range) {
    return std::copysign(std::min(std::abs(angle) / range.gaze_deg, 1.0f) * range.turn, angle);
  };
  return EyeTo({turned(gaze[kDown], gaze[kDown] < 0 ? data_.look->up : data_.look->down),
                turned(gaze[kToRight], outward ? data_.look->outer : data_.look->inner)});
}

void Rig::MoveBones(Frame& frame) const {
  const Sided<glm::mat3> turn{EyeTurn(frame.pose, Side::kRight), EyeTurn(frame.pose, Side::kLeft)};
  for (const std::uint32_t i : rigid_) {
    glm::vec3& p = frame.position[i];
    glm::vec3& n = frame.normal[i];
    const Bone bone = data_.bone[i];
    if (bone == Bone::kJaw) {
      const glm::vec3 tip = TurnJaw(p + n, frame.pose, 1);
      p = TurnJaw(p, frame.pose, 1);
      n = glm::normalize(tip - p);
    } else if (const auto eye = EyeOf(bone)) {
      const glm::vec3 pivot = data_.eye_pivot[*eye];
      p = pivot + turn[*eye] * (p - pivot);
      n = turn[*eye] * n;
    }
  }
}

void Rig::TurnNeck(Frame& frame) const {
  for (std::size_t i = 0; i < frame.position.size(); ++i) {
    frame.position[i] = TurnHead(frame.position[i], frame.pose, data_.weights[i].neck);
  }
  for (const std::uint32_t i : rigid_) frame.normal[i] = frame.pose.head * frame.normal[i];
}

void Rig::Swing(Frame& frame) const {
  if (frame.swings.empty()) return;
  for (const auto& [vertex, spring, weight] : data_.spring_weights) {
    frame.position[vertex] += weight * frame.swings[spring];
  }
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
