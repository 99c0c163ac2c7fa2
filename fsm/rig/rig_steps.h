#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/rig/rig_data.h"
#include "fsm/rig/steps.h"

namespace fsm {

class RecordCollector;
class VertexChecker;
class VertexPick;

/// Vertex lists that several steps loop over, found once for a rig.
struct MovedVertices {
  explicit MovedVertices(const RigData& data);
  std::vector<std::uint32_t> jawed;   ///< skin that the jaw moves
  std::vector<std::uint32_t> rigid;   ///< of all bones but the skin
  std::vector<std::uint32_t> tongue;  ///< of the tongue's bone
  std::vector<std::uint32_t> soft;    ///< whose normals are computed from moved triangles
};

/// What the steps read and write while they compute the vertices of one state.
struct StepWork {
  step::StepState state;
  std::span<const float> strengths;  ///< by channel
  std::span<const glm::vec3> spring_offsets;
  std::span<glm::vec3> position;
  std::span<glm::vec3> normal;  ///< empty if only steps that shape the skin are applied
};

/// All that the code knows of one RigStep beside its arithmetic in steps.glsl.
struct StepDefinition {
  RigStep step;
  /// As `fsm --describe` shows it; rig_kernels.glsl has the step's kernel after STEP_ and this.
  const char* name;
  /// Takes the step on the processor.
  void (*apply)(const RigData& data, const MovedVertices& moved, StepWork& work);
  /// Refuses data that lack what the step needs (VertexChecker); null: it needs nothing.
  void (*check)(const RigData& data, const VertexChecker& checker);
  /// Reduces the step's data to some vertices (OnlyVertices); null: they name no vertices.
  void (*pick)(RigData& data, const VertexPick& pick);
  /// Adds the vertices, beside those of MouthVertices, from which the step derives the positions
  /// of others; null: none.
  void (*reads)(const RigData& data, std::vector<std::uint32_t>& vertices);
  /// Packs what the step's kernel reads of a rig; its name is that of the step.
  void (*pack)(const RigData& data, const char* kernel, RecordCollector& out);
};
const StepDefinition& DefinitionOf(RigStep step);

/// The table of the steps, in the order of RigStep: those that shape the skin, and the others.
std::span<const StepDefinition> SkinStepDefinitions();
std::span<const StepDefinition> BodyStepDefinitions();
/// Tells whether the definitions are in the order of RigStep, from `first` on.
constexpr bool AreInOrder(std::span<const StepDefinition> definitions, RigStep first) {
  auto expected = static_cast<std::size_t>(first);
  for (const StepDefinition& definition : definitions) {
    if (definition.step != static_cast<RigStep>(expected++)) return false;
  }
  return true;
}

/// Refuses (vm::Failure, kBadValue) data that do not meet what RigData and its steps say.
void CheckRig(const RigData& data);

}  // namespace fsm
