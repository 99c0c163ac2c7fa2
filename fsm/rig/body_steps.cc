// The steps after those that shape the skin, which move tongue, bones, neck and normals: each
// takes, checks, picks and packs its data. steps.glsl says what happens to one vertex.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "fsm/rig/reach.h"
#include "fsm/rig/rig_records.h"
#include "fsm/rig/rig_steps.h"
#include "fsm/rig/vertex_checker.h"
#include "fsm/rig/vertex_pick.h"

namespace fsm {
namespace {

using step::PointAt;

/// Interpolates the lips at `x` between the pairs of the seam, which go from -x to +x.
step::LipPair LipsAt(float x, const MouthVertices& mouth, std::span<const glm::vec3> position) {
  const auto pair = [&](auto at) {
    return step::LipPair{position[at->first], position[at->second]};
  };
  const auto right = std::ranges::lower_bound(
      mouth.seam, x, {}, [&](const auto& vertices) { return position[vertices.first].x; });
  return step::LipsBetween(pair(right == mouth.seam.begin() ? right : right - 1),
                           pair(right == mouth.seam.end() ? right - 1 : right), x);
}

void ApplyTongue(const RigData& data, const MovedVertices& moved, StepWork& work) {
  const step::Mouth& mouth = work.state.mouth;
  step::TonguePath path = step::PathPastTeeth(mouth);
  for (const auto& [upper, lower] : data.mouth.seam)
    path = step::LipsOnPath(path, {work.position[upper], work.position[lower]});
  const float out_mm = step::TongueProtrusion(path, mouth);
  for (const std::uint32_t i : moved.tongue) {
    work.normal[i] = step::NormalWithJaw(mouth.jaw, data.rest[i], data.rest_normal[i]);
    glm::vec3& p = work.position[i];
    p = step::RaisedTongue(mouth, out_mm, data.rest[i], data.weights[i].free);
    if (data.mouth.seam.empty()) continue;
    p = out_mm > 0 ? step::TongueOverTeeth(
                         path, mouth, out_mm, p,
                         LipsAt(step::NarrowTongue(path, p).x, data.mouth, work.position))
                   : step::BehindTeeth(mouth, p);
  }
}

void CheckTongue(const RigData& data, const VertexChecker& checker) {
  if (data.mouth.seam.empty() || std::ranges::find(data.bone, Bone::kTongue) == data.bone.end())
    return;
  checker.Positive(data.teeth.upper.half_width, "rig.upper_teeth.half_width");
  checker.Positive(data.teeth.lower.half_width, "rig.lower_teeth.half_width");
}

/// Records are the vertices of the tongue; entries are the pairs of the lip seam.
void PackTongue(const RigData& data, const char* kernel, RecordCollector& out) {
  std::vector<step::TongueRecord> records;
  for (const std::uint32_t i : MovedVertices(data).tongue) {
    records.push_back(
        {i, PointAt(data.rest[i]), PointAt(data.rest_normal[i]), data.weights[i].free});
  }
  std::vector<step::SeamEntry> seam;
  for (const auto& [upper, lower] : data.mouth.seam) seam.push_back({upper, lower});
  out.Add(kernel, records, seam);
}

void ApplyBones(const RigData& data, const MovedVertices& moved, StepWork& work) {
  for (const std::uint32_t i : moved.rigid) {
    glm::vec3& p = work.position[i];
    glm::vec3& n = work.normal[i];
    if (data.bone[i] == Bone::kJaw) {
      n = step::NormalWithJaw(work.state.mouth.jaw, p, n);
      p = step::WithJaw(work.state.mouth.jaw, p, 1);
    } else if (const auto side = SideOfEye(data.bone[i])) {
      const step::Eye& eye = work.state.eyes[static_cast<std::size_t>(*side)];
      p = step::WithGaze(eye, p);
      n = step::Rotated(eye.gaze, n);
    }
  }
}

void CheckBones(const RigData& data, const VertexChecker& checker) {
  if (const auto& ranges = data.eyes.gaze_ranges) {
    for (const GazeRange& range : {ranges->inner, ranges->outer, ranges->up, ranges->down})
      checker.Positive(range.gaze_deg, "rig.gaze_ranges.gaze_deg");
  }
}

void PackBones(const RigData& data, const char* kernel, RecordCollector& out) {
  std::vector<step::BoneRecord> records;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] == Bone::kJaw) records.push_back({i, step::kJawBone});
    if (const auto eye = SideOfEye(data.bone[i])) records.push_back({i, std::uint32_t(*eye)});
  }
  out.Add(kernel, records);
}

void ApplyNeck(const RigData& data, const MovedVertices& moved, StepWork& work) {
  const step::Neck& neck = work.state.neck;
  for (std::size_t i = 0; i < work.position.size(); ++i)
    work.position[i] = step::WithNeck(neck, work.position[i], data.weights[i].neck);
  for (const std::uint32_t i : moved.rigid)
    work.normal[i] = step::Rotated(neck.rotation, work.normal[i]);
}

void PackNeck(const RigData& data, const char* kernel, RecordCollector& out) {
  std::vector<step::NeckRecord> records;
  for (std::size_t i = 0; i < data.rest.size(); ++i)
    records.push_back({data.weights[i].neck, data.bone[i] != Bone::kSkin ? 1U : 0U});
  out.Add(kernel, records);
}

void ApplySprings(const RigData& data, const MovedVertices&, StepWork& work) {
  if (work.spring_offsets.empty()) return;
  for (const auto& [vertex, spring, weight] : data.spring_rig.weights)
    work.position[vertex] += weight * work.spring_offsets[spring];
}

void CheckSpring(const Spring& spring, const std::string& place) {
  const auto within = [&](const char* member, float value, float min, float max) {
    if (value >= min && value <= max) return;  // false for not-a-number
    VertexChecker::Refuse(fmt::format("{}: {} outside {}..{}", place, member, min, max));
  };
  if (!WithinReach(spring.rest) || !WithinReach(spring.root))
    VertexChecker::Refuse(place + ": too far away");
  within("frequency_hz", spring.frequency_hz, Spring::kMinHz, Spring::kMaxHz);
  within("damping", spring.damping, Spring::kMinDamping, Spring::kMaxDamping);
  within("hang", spring.hang, 0, 1);
  within("reach_mm", spring.reach_mm, Spring::kMinReachMm, Spring::kMaxReachMm);
  if (!(glm::dot(spring.outward, spring.outward) <= 1.01f))
    VertexChecker::Refuse(place + ": outward is longer than 1");
}

void CheckSprings(const RigData& data, const VertexChecker& checker) {
  const auto& [springs, weights] = data.spring_rig;
  for (std::size_t i = 0; i < springs.size(); ++i)
    CheckSpring(springs[i], checker.Element("rig.springs", i));
  checker.VerticesOf(weights, "rig.spring_weights");
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i].spring < springs.size()) continue;
    checker.Refuse(fmt::format("rig.spring_weights[{}]: spring {} of {}", i, weights[i].spring,
                               springs.size()));
  }
}

void PickSprings(RigData& data, const VertexPick& pick) {
  pick.VerticesOf(data.spring_rig.weights);
}

void PackSprings(const RigData& data, const char* kernel, RecordCollector& out) {
  VertexLists<step::SpringEntry> lists(data.rest.size());
  for (const auto& [vertex, spring, weight] : data.spring_rig.weights)
    lists[vertex].push_back({spring, weight});
  lists.AddTo(out, kernel);
}

void ApplyNormals(const RigData& data, const MovedVertices& moved, StepWork& work) {
  ComputeNormals(data.normals, moved.soft, work.position, work.normal);
}

void CheckNormals(const RigData& data, const VertexChecker& checker) {
  checker.EmptyOrPerVertex(data.normals.twin.size(), "rig.normal_twin");
  checker.Vertices(data.normals.twin, "rig.normal_twin");
  checker.Triangles(data.normals.soft_triangles, "rig.soft_triangles");
}

void PickNormals(RigData& data, const VertexPick&) { data.normals = {}; }  // none are computed

/// Each vertex lists all triangles around it and around the vertices that share its normal.
void PackNormals(const RigData& data, const char* kernel, RecordCollector& out) {
  const NormalRig& normals = data.normals;
  const std::vector<std::uint32_t>& t = normals.soft_triangles;
  VertexLists<step::TriangleEntry> lists(data.rest.size());
  for (std::size_t k = 0; k + 2 < t.size(); k += 3) {
    for (std::size_t c = 0; c < 3; ++c)
      lists[normals.Owner(t[k + c])].push_back({t[k], t[k + 1], t[k + 2]});
  }
  for (const std::uint32_t i : t) {
    if (normals.Owner(i) != i) lists[i] = lists[normals.Owner(i)];
  }
  lists.AddTo(out, kernel);
}

constexpr std::array kBodyTable{
    StepDefinition{RigStep::kTongue, "tongue", ApplyTongue, CheckTongue, nullptr, nullptr,
                   PackTongue},
    StepDefinition{RigStep::kBones, "bones", ApplyBones, CheckBones, nullptr, nullptr, PackBones},
    StepDefinition{RigStep::kNeck, "neck", ApplyNeck, nullptr, nullptr, nullptr, PackNeck},
    StepDefinition{RigStep::kSprings, "springs", ApplySprings, CheckSprings, PickSprings, nullptr,
                   PackSprings},
    StepDefinition{RigStep::kNormals, "normals", ApplyNormals, CheckNormals, PickNormals, nullptr,
                   PackNormals}};
static_assert(AreInOrder(kBodyTable, RigStep::kTongue) &&
              kBodyTable.size() == kRigSteps - kSkinSteps);

}  // namespace

std::span<const StepDefinition> BodyStepDefinitions() { return kBodyTable; }

}  // namespace fsm
