#include "fsm/rig/rig_steps.h"

#include <fmt/format.h>

#include <algorithm>

#include "fsm/rig/reach.h"
#include "fsm/rig/rig_records.h"
#include "fsm/rig/vertex_checker.h"
#include "fsm/rig/vertex_pick.h"

namespace fsm {
namespace {

void CheckOrder(const std::vector<RigStep>& steps) {
  if (steps.size() > RigData::kMaxSteps) {
    VertexChecker::Refuse(
        fmt::format("rig.steps: {}, at most {} expected", steps.size(), RigData::kMaxSteps));
  }
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const bool in_order = ShapesSkin(steps[i]) ? ShapesSkin(steps[i - 1]) : steps[i - 1] < steps[i];
    if (in_order) continue;
    VertexChecker::Refuse(
        fmt::format("{}: {} cannot come after {}", VertexChecker::Element("rig.steps", i),
                    DefinitionOf(steps[i]).name, DefinitionOf(steps[i - 1]).name));
  }
}

/// Calls a function with every StepDefinition.
void ForEachStep(const auto& visit) {
  for (const auto definitions : {SkinStepDefinitions(), BodyStepDefinitions()})
    std::ranges::for_each(definitions, visit);
}

}  // namespace

MovedVertices::MovedVertices(const RigData& data) {
  std::vector<bool> is_soft(data.rest.size(), false);
  for (const std::uint32_t i : data.normals.soft_triangles) is_soft[i] = true;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] != Bone::kSkin) rigid.push_back(i);
    if (data.bone[i] == Bone::kTongue) tongue.push_back(i);
    if (data.bone[i] == Bone::kSkin && data.weights[i].jaw > 0.001f) jawed.push_back(i);
    if (is_soft[i]) soft.push_back(i);
  }
}

const StepDefinition& DefinitionOf(RigStep step) {
  const auto index = static_cast<std::size_t>(step);
  return ShapesSkin(step) ? SkinStepDefinitions()[index]
                          : BodyStepDefinitions()[index - kSkinSteps];
}

void CheckRig(const RigData& data) {
  const VertexChecker checker(data.rest.size());
  for (std::size_t i = 0; i < data.rest.size(); ++i) {
    if (!WithinReach(data.rest[i]))
      checker.Refuse(checker.Element("rig.rest", i) + ": too far away");
  }
  checker.PerVertex(data.rest_normal.size(), "rig.rest_normal");
  checker.PerVertex(data.bone.size(), "rig.bone");
  checker.PerVertex(data.weights.size(), "rig.weights");
  CheckOrder(data.steps);
  ForEachStep([&](const StepDefinition& definition) {
    if (definition.check) definition.check(data, checker);
  });
  const auto& [seam, corners, incisors] = data.mouth;
  checker.Pairs(seam, "rig.mouth.seam");
  if (corners) checker.Vertices(corners->InOrder(), "rig.mouth.corners");
  if (!incisors) return;
  for (const std::uint32_t vertex : {incisors->upper, incisors->lower, incisors->upper_root})
    checker.Vertex(vertex, "rig.mouth.incisors");
}

std::vector<std::uint32_t> StepVertices(const RigData& data) {
  std::vector<std::uint32_t> vertices;
  for (const auto& [upper, lower] : data.mouth.seam)
    vertices.insert(vertices.end(), {upper, lower});
  if (const auto& corners = data.mouth.corners)
    vertices.insert(vertices.end(), {corners->right, corners->left});
  if (data.rest.empty()) return vertices;
  ForEachStep([&](const StepDefinition& definition) {
    if (definition.reads) definition.reads(data, vertices);
  });
  return vertices;
}

RigData OnlyVertices(const RigData& data, std::span<const std::uint32_t> vertices) {
  RigData some = data;
  if (data.rest.empty()) return some;
  const VertexPick pick(data.rest.size(), vertices);
  pick.PerVertex(some.rest);
  pick.PerVertex(some.rest_normal);
  pick.PerVertex(some.bone);
  pick.PerVertex(some.weights);
  for (auto& [upper, lower] : some.mouth.seam) upper = pick[upper], lower = pick[lower];
  if (auto& corners = some.mouth.corners) corners = {pick[corners->right], pick[corners->left]};
  some.mouth.incisors.reset();  // only the renderer needs them
  ForEachStep([&](const StepDefinition& definition) {
    if (definition.pick) definition.pick(some, pick);
  });
  return some;
}

std::vector<KernelRecords> PackRig(const RigData& data) {
  RecordCollector out;
  std::vector<step::RestRecord> rest;
  for (std::size_t i = 0; i < data.rest.size(); ++i)
    rest.push_back({step::PointAt(data.StartPositions()[i]), step::PointAt(data.rest_normal[i])});
  out.Add("begin", rest);
  for (const RigStep step : data.steps) {
    const StepDefinition& definition = DefinitionOf(step);
    definition.pack(data, definition.name, out);
  }
  return out.Release();
}

}  // namespace fsm
