// The steps that shape the skin of a head that looks ahead: each takes, checks, picks and packs its
// data. steps.glsl says what happens to one vertex.

#include <fmt/format.h>

#include <array>

#include "fsm/rig/rig_records.h"
#include "fsm/rig/rig_steps.h"
#include "fsm/rig/vertex_checker.h"
#include "fsm/rig/vertex_pick.h"

namespace fsm {
namespace {

using step::PointAt;

void ApplyChannels(const RigData& data, const MovedVertices&, StepWork& work) {
  for (std::size_t k = 0; k < data.channels.size(); ++k) {
    const float strength = work.strengths[k];
    if (strength == 0) continue;
    for (const Displacement& d : data.channels[k].moves)
      work.position[d.vertex] += strength * d.offset;
  }
}

/// Returns the max `number` of a Drive of this kind.
std::size_t MaxNumber(Drive::Kind kind) {
  using enum Drive::Kind;
  switch (kind) {
    case kUnit:
    case kCommandedUnit:
      return UnitValues::kMax;
    case kMouth:
    case kSpokenMouth:
    case kHandMouth:
      return kMouthParameters - 1;
    case kResidual:
      return Residuals{}.size() - 1;
    case kBlink:
    case kGazeUp:
    case kGazeRight:
      return 0;
  }
  return 0;
}

void CheckChannels(const RigData& data, const VertexChecker& checker) {
  for (std::size_t i = 0; i < data.channels.size(); ++i) {
    const Channel& channel = data.channels[i];
    const std::string place = checker.Element("rig.channels", i);
    for (const auto& [drive, gain] : channel.drivers) {
      if (const std::size_t max = MaxNumber(drive.kind); drive.number > max)
        checker.Refuse(fmt::format("{}: number {} above {}", place, drive.number, max));
    }
    if (!(channel.min <= channel.max)) {  // true for not-a-number, too
      checker.Refuse(fmt::format("{}: min {} is above max {}", place, channel.min, channel.max));
    }
    checker.VerticesOf(channel.moves, place + ".moves");
  }
}

void PickChannels(RigData& data, const VertexPick& pick) {
  for (Channel& channel : data.channels) pick.VerticesOf(channel.moves);
}

void PackChannels(const RigData& data, const char* kernel, RecordCollector& out) {
  VertexLists<step::ChannelEntry> lists(data.rest.size());
  for (std::uint32_t k = 0; k < data.channels.size(); ++k) {
    for (const Displacement& move : data.channels[k].moves)
      lists[move.vertex].push_back({k, PointAt(move.offset)});
  }
  lists.AddTo(out, kernel);
}

void ApplyLids(const RigData& data, const MovedVertices&, StepWork& work) {
  for (const LidRig::Vertex& lid : data.lids.vertices) {
    const step::Eye& eye = work.state.eyes[static_cast<std::size_t>(lid.side)];
    glm::vec3& p = work.position[lid.vertex];
    p = step::WithLids(lid.point, eye, p);
    if (lid.is_lid) p = step::OverCornea(eye, p);
  }
}

void CheckLids(const RigData& data, const VertexChecker& checker) {
  checker.VerticesOf(data.lids.vertices, "rig.lids.vertices");
}

void PickLids(RigData& data, const VertexPick& pick) { pick.VerticesOf(data.lids.vertices); }

void PackLids(const RigData& data, const char* kernel, RecordCollector& out) {
  std::vector<step::LidRecord> records;
  for (const LidRig::Vertex& lid : data.lids.vertices) {
    records.push_back(
        {lid.vertex, static_cast<std::uint32_t>(lid.side), lid.point, lid.is_lid ? 1U : 0U});
  }
  out.Add(kernel, records);
}

void ApplyLidsOnBalls(const RigData& data, const MovedVertices&, StepWork& work) {
  for (const auto& [vertex, side, min_radius] : data.ball_lids) {
    glm::vec3& p = work.position[vertex];
    p = step::OutOfBall(data.eyes.centre[side], min_radius, p);
  }
}

void CheckLidsOnBalls(const RigData& data, const VertexChecker& checker) {
  checker.VerticesOf(data.ball_lids, "rig.ball_lids");
}

void PickLidsOnBalls(RigData& data, const VertexPick& pick) { pick.VerticesOf(data.ball_lids); }

void PackLidsOnBalls(const RigData& data, const char* kernel, RecordCollector& out) {
  std::vector<step::BallLidRecord> records;
  for (const BallLid& lid : data.ball_lids)
    records.push_back({lid.vertex, static_cast<std::uint32_t>(lid.side), lid.min_radius});
  out.Add(kernel, records);
}

void ApplyJaw(const RigData& data, const MovedVertices& moved, StepWork& work) {
  const step::Jaw& jaw = work.state.mouth.jaw;
  if (jaw.open == 0 && jaw.slide == 0 && jaw.sway == 0) return;
  for (const std::uint32_t i : moved.jawed)
    work.position[i] = step::WithJaw(jaw, work.position[i], data.weights[i].jaw);
}

void PackJaw(const RigData& data, const char* kernel, RecordCollector& out) {
  std::vector<step::JawRecord> records;
  for (const std::uint32_t i : MovedVertices(data).jawed)
    records.push_back({i, data.weights[i].jaw});
  out.Add(kernel, records);
}

void ApplyJawByChin(const RigData& data, const MovedVertices&, StepWork& work) {
  step::Jaw& jaw = work.state.mouth.jaw;
  jaw = step::JawByChin(jaw, data.rest[data.jaw.chin], work.position[data.jaw.chin]);
}

void CheckJawByChin(const RigData& data, const VertexChecker& checker) {
  checker.Vertex(data.jaw.chin, "rig.chin");
}

void PickJawByChin(RigData& data, const VertexPick& pick) { data.jaw.chin = pick[data.jaw.chin]; }

void ReadChin(const RigData& data, std::vector<std::uint32_t>& vertices) {
  vertices.push_back(data.jaw.chin);
}

void PackJawByChin(const RigData& data, const char* kernel, RecordCollector& out) {
  const std::uint32_t chin = data.jaw.chin;
  out.Add(kernel, std::vector<step::ChinRecord>{{chin, PointAt(data.rest[chin])}});
}

void ApplyTeeth(const RigData& data, const MovedVertices&, StepWork& work) {
  for (const auto& [vertex, upper_gap, lower_gap] : data.teeth.contacts) {
    glm::vec3& p = work.position[vertex];
    p = step::OffTeeth(work.state.mouth, p, upper_gap, lower_gap);
  }
}

void CheckTeeth(const RigData& data, const VertexChecker& checker) {
  checker.VerticesOf(data.teeth.contacts, "rig.teeth_contacts");
  if (data.teeth.contacts.empty()) return;
  checker.Positive(data.teeth.upper.half_width, "rig.upper_teeth.half_width");
  checker.Positive(data.teeth.lower.half_width, "rig.lower_teeth.half_width");
}

void PickTeeth(RigData& data, const VertexPick& pick) { pick.VerticesOf(data.teeth.contacts); }

void PackTeeth(const RigData& data, const char* kernel, RecordCollector& out) {
  std::vector<step::ContactRecord> records;
  for (const auto& [vertex, upper_gap, lower_gap] : data.teeth.contacts)
    records.push_back({vertex, upper_gap, lower_gap});
  out.Add(kernel, records);
}

void ApplyLips(const RigData& data, const MovedVertices&, StepWork& work) {
  const LipRig& rig = data.lips;
  thread_local std::vector<glm::vec3> gaps;  // by pair; kept from frame to frame
  gaps.clear();
  for (std::size_t k = 0; k < data.mouth.seam.size(); ++k) {
    const auto& [upper, lower] = data.mouth.seam[k];
    gaps.push_back(step::LipGap(work.state.mouth.seal, work.position[upper], work.position[lower],
                                rig.ApartAtRest(k)));
  }
  for (const LipRig::Follower& f : rig.followers)
    work.position[f.vertex] -= LipRig::ShareOf(f) * gaps[f.pair];
}

void CheckLips(const RigData& data, const VertexChecker& checker) {
  const LipRig& lips = data.lips;
  const std::size_t pairs = data.mouth.seam.size();
  if (!lips.apart_at_rest.empty() && lips.apart_at_rest.size() != pairs)
    checker.Refuse("rig.lips.apart_at_rest: not one for each pair of the seam");
  checker.VerticesOf(lips.followers, "rig.lips.followers");
  for (std::size_t i = 0; i < lips.followers.size(); ++i) {
    if (lips.followers[i].pair < pairs) continue;
    checker.Refuse(
        fmt::format("rig.lips.followers[{}]: pair {} of {}", i, lips.followers[i].pair, pairs));
  }
}

void PickLips(RigData& data, const VertexPick& pick) { pick.VerticesOf(data.lips.followers); }

void PackLips(const RigData& data, const char* kernel, RecordCollector& out) {
  const LipRig& lips = data.lips;
  std::vector<step::GapRecord> gaps;
  for (std::size_t k = 0; k < data.mouth.seam.size(); ++k) {
    const auto& [upper, lower] = data.mouth.seam[k];
    gaps.push_back({upper, lower, PointAt(lips.ApartAtRest(k))});
  }
  out.Add("lip_gaps", gaps);
  VertexLists<step::LipEntry> lists(data.rest.size());
  for (const LipRig::Follower& f : lips.followers)
    lists[f.vertex].push_back({f.pair, LipRig::ShareOf(f)});
  lists.AddTo(out, kernel);
}

void ApplyOwnForm(const RigData& data, const MovedVertices&, StepWork& work) {
  const std::vector<glm::vec3>& to_own = data.proxy.to_own;
  for (std::size_t i = 0; i < to_own.size(); ++i) work.position[i] += to_own[i];
}

void CheckOwnForm(const RigData& data, const VertexChecker& checker) {
  checker.EmptyOrPerVertex(data.proxy.rest.size(), "rig.proxy_rest");
  if (data.proxy.to_own.size() != data.proxy.rest.size())
    checker.Refuse("rig.proxy_to_own: not one for each of rig.proxy_rest");
}

void PickOwnForm(RigData& data, const VertexPick& pick) {
  pick.PerVertex(data.proxy.rest);
  pick.PerVertex(data.proxy.to_own);
}

void PackOwnForm(const RigData& data, const char* kernel, RecordCollector& out) {
  out.Add(kernel, data.proxy.to_own);
}

constexpr std::array kSkinTable{
    StepDefinition{RigStep::kChannels, "channels", ApplyChannels, CheckChannels, PickChannels,
                   nullptr, PackChannels},
    StepDefinition{RigStep::kLids, "lids", ApplyLids, CheckLids, PickLids, nullptr, PackLids},
    StepDefinition{RigStep::kLidsOnBalls, "lids_on_balls", ApplyLidsOnBalls, CheckLidsOnBalls,
                   PickLidsOnBalls, nullptr, PackLidsOnBalls},
    StepDefinition{RigStep::kJaw, "jaw", ApplyJaw, nullptr, nullptr, nullptr, PackJaw},
    StepDefinition{RigStep::kJawByChin, "jaw_by_chin", ApplyJawByChin, CheckJawByChin,
                   PickJawByChin, ReadChin, PackJawByChin},
    StepDefinition{RigStep::kTeeth, "teeth", ApplyTeeth, CheckTeeth, PickTeeth, nullptr, PackTeeth},
    StepDefinition{RigStep::kLips, "lips", ApplyLips, CheckLips, PickLips, nullptr, PackLips},
    StepDefinition{RigStep::kOwnForm, "own_form", ApplyOwnForm, CheckOwnForm, PickOwnForm, nullptr,
                   PackOwnForm}};

static_assert(AreInOrder(kSkinTable, RigStep::kChannels) && kSkinTable.size() == kSkinSteps);

}  // namespace

std::span<const StepDefinition> SkinStepDefinitions() { return kSkinTable; }

}  // namespace fsm
