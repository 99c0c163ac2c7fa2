#include "fsm/rig/rig_steps.h"

#include <algorithm>
#include <array>

namespace fsm {
namespace {

// Each function loops over the vertices of a step; steps.glsl says what happens to one of them.

void AddChannels(const std::vector<Channel>& channels, StepWork& work) {
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const float strength = work.strengths[k];
    if (strength == 0) continue;
    for (const Displacement& d : channels[k].moves) work.position[d.vertex] += strength * d.by;
  }
}

void MoveLids(const LidRig& rig, StepWork& work) {
  for (const LidRig::Vertex& lid : rig.vertices) {
    const step::Eye& eye = work.state.eyes[static_cast<std::size_t>(lid.side)];
    glm::vec3& p = work.position[lid.vertex];
    p = step::WithLids(lid.at, eye, p);
    if (lid.proper) p = step::OverCornea(eye, p);
  }
}

void KeepOutside(const BallLids& lids, StepWork& work) {
  for (const auto& [vertex, side, least] : lids.vertices) {
    glm::vec3& p = work.position[vertex];
    p = step::OutOfBall(lids.centre[side], least, p);
  }
}

void MoveWithJaw(const RigData& data, std::span<const std::uint32_t> jawed, StepWork& work) {
  const step::Jaw& jaw = work.state.mouth.jaw;
  if (jaw.open == 0 && jaw.slide == 0 && jaw.sway == 0) return;
  for (const std::uint32_t i : jawed)
    work.position[i] = step::WithJaw(jaw, work.position[i], data.weights[i].jaw);
}

void KeepOffTeeth(const TeethRig& rig, StepWork& work) {
  for (const auto& [vertex, upper_gap, lower_gap] : rig.contacts) {
    glm::vec3& p = work.position[vertex];
    p = step::OffTeeth(work.state.mouth, p, upper_gap, lower_gap);
  }
}

void CloseLips(const LipRig& rig, StepWork& work) {
  thread_local std::vector<glm::vec3> gaps;  // kept from frame to frame
  gaps.clear();
  for (std::size_t k = 0; k < rig.seam.size(); ++k) {
    const auto& [upper, lower] = rig.seam[k];
    gaps.push_back(step::LipGap(work.state.mouth.seal, work.position[upper], work.position[lower],
                                rig.ApartAtRest(k)));
  }
  for (const LipRig::Follower& f : rig.followers)
    work.position[f.vertex] -= LipRig::ShareOf(f) * gaps[f.pair];
}

void AddOwnForm(std::span<const glm::vec3> to_own, StepWork& work) {
  for (std::size_t i = 0; i < to_own.size(); ++i) work.position[i] += to_own[i];
}

/// The positions of a pair of lip vertices, or of a point interpolated between two pairs.
struct Lips {
  glm::vec3 upper, lower;
};

/// Interpolates the lips at `x` between the pairs of the seam, which go from -x to +x.
Lips LipsAt(float x, const LipRig& rig, std::span<const glm::vec3> position) {
  const auto pair = [&](auto at) { return Lips{position[at->first], position[at->second]}; };
  const auto right = std::ranges::lower_bound(
      rig.seam, x, {}, [&](const auto& vertices) { return position[vertices.first].x; });
  if (right == rig.seam.begin()) return pair(right);
  if (right == rig.seam.end()) return pair(right - 1);
  const Lips a = pair(right - 1), b = pair(right);
  const float t = (x - a.upper.x) / std::max(b.upper.x - a.upper.x, 1e-3F);
  return {glm::mix(a.upper, b.upper, t), glm::mix(a.lower, b.lower, t)};
}

void MoveTongue(const RigData& data, std::span<const std::uint32_t> tongue, StepWork& work) {
  const step::Mouth& mouth = work.state.mouth;
  step::TonguePath path = step::PathPastTeeth(mouth);
  for (const auto& [upper, lower] : data.lips.seam)
    path = step::LipsOnPath(path, work.position[upper], work.position[lower]);
  const float out_mm = step::ComesOut(path, mouth);
  const float through = SmoothStep(0, step::kTongueOut, out_mm);  // 0 = within the mouth, 1 = out
  for (const std::uint32_t i : tongue) {
    const glm::vec3 rest = data.rest[i];
    work.normal[i] = step::NormalWithJaw(mouth.jaw, rest, data.rest_normal[i]);
    glm::vec3& p = work.position[i];
    p = step::RaisedTongue(mouth, out_mm, rest, data.weights[i].free);
    if (data.lips.seam.empty()) continue;
    const glm::vec3 within = step::BehindTeeth(mouth, p);
    if (through > 0) {
      const glm::vec3 narrow = step::NarrowTongue(path, p);
      const Lips lips = LipsAt(narrow.x, data.lips, work.position);
      p = glm::mix(within,
                   step::BetweenLips(path, mouth, narrow, step::LowerTeethZ(mouth, p.x), lips.upper,
                                     lips.lower),
                   through);
    } else {
      p = within;
    }
  }
}

void MoveBones(const RigData& data, std::span<const std::uint32_t> rigid, StepWork& work) {
  for (const std::uint32_t i : rigid) {
    glm::vec3& p = work.position[i];
    glm::vec3& n = work.normal[i];
    if (data.bone[i] == Bone::kJaw) {
      n = step::NormalWithJaw(work.state.mouth.jaw, p, n);
      p = step::WithJaw(work.state.mouth.jaw, p, 1);
    } else if (const auto side = EyeOf(data.bone[i])) {
      const step::Eye& eye = work.state.eyes[static_cast<std::size_t>(*side)];
      p = step::WithGaze(eye, p);
      n = step::Rotated(eye.gaze, n);
    }
  }
}

void TurnNeck(const RigData& data, std::span<const std::uint32_t> rigid, StepWork& work) {
  const step::Neck& neck = work.state.neck;
  for (std::size_t i = 0; i < work.position.size(); ++i)
    work.position[i] = step::WithNeck(neck, work.position[i], data.weights[i].neck);
  for (const std::uint32_t i : rigid) work.normal[i] = step::Rotated(neck.turn, work.normal[i]);
}

void Swing(std::span<const SpringWeight> weights, StepWork& work) {
  if (work.swings.empty()) return;
  for (const auto& [vertex, spring, weight] : weights)
    work.position[vertex] += weight * work.swings[spring];
}

}  // namespace

MovedVertices::MovedVertices(const RigData& data) {
  std::vector<bool> is_soft(data.rest.size(), false);
  for (const std::uint32_t i : data.normals.soft_triangles) is_soft[i] = true;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] != Bone::kSkin) rigid.push_back(i);
    if (data.bone[i] == Bone::kTongue) tongue.push_back(i);
    if (MovesWithJaw(data, i)) jawed.push_back(i);
    if (is_soft[i]) soft.push_back(i);
  }
}

std::string_view NameOf(RigStep step) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(RigStep::kNormals) + 1>
      kNames{"channels", "lids",   "lids_on_balls", "jaw",  "jaw_by_chin", "teeth",  "lips",
             "own_form", "tongue", "bones",         "neck", "springs",     "normals"};
  return kNames[static_cast<std::size_t>(step)];
}

void Take(RigStep step, const RigData& data, const MovedVertices& moved, StepWork& work) {
  switch (step) {
    using enum RigStep;
    case kChannels:
      return AddChannels(data.channels, work);
    case kLids:
      return MoveLids(data.lids, work);
    case kLidsOnBalls:
      return KeepOutside(data.ball_lids, work);
    case kJaw:
      return MoveWithJaw(data, moved.jawed, work);
    case kJawByChin: {
      step::Jaw& jaw = work.state.mouth.jaw;
      jaw = step::JawByChin(jaw, data.rest[data.jaw.chin], work.position[data.jaw.chin]);
      return;
    }
    case kTeeth:
      return KeepOffTeeth(data.teeth, work);
    case kLips:
      return CloseLips(data.lips, work);
    case kOwnForm:
      return AddOwnForm(data.proxy.to_own, work);
    case kTongue:
      return MoveTongue(data, moved.tongue, work);
    case kBones:
      return MoveBones(data, moved.rigid, work);
    case kNeck:
      return TurnNeck(data, moved.rigid, work);
    case kSprings:
      return Swing(data.swing.weights, work);
    case kNormals:
      return FindNormals(data.normals, moved.soft, work.position, work.normal);
  }
}

}  // namespace fsm
