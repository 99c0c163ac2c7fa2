#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "fsm/rig/rig_data.h"
#include "fsm/rig/steps.h"

namespace fsm {

/// Vertex lists of the steps jaw, bones, tongue and kNormals, found once for a rig.
struct MovedVertices {
  explicit MovedVertices(const RigData& data);
  std::vector<std::uint32_t> jawed, rigid, tongue, soft;
};

/// What the steps read and write while they compute the vertices of one state.
struct StepWork {
  step::StepState state;
  std::span<const float> strengths;  ///< by channel
  std::span<const glm::vec3> swings;
  std::span<glm::vec3> position;
  std::span<glm::vec3> normal;  ///< empty if only steps that shape the skin are taken
};

/// Takes one step on the processor.
void Take(RigStep step, const RigData& data, const MovedVertices& moved, StepWork& work);

/// Returns the step's name, as `fsm --describe` shows it and rig_kernels.glsl has it after STEP_.
std::string_view NameOf(RigStep step);

/// Tells whether a vertex is skin that the jaw moves.
inline bool MovesWithJaw(const RigData& data, std::uint32_t vertex) {
  return data.bone[vertex] == Bone::kSkin && data.weights[vertex].jaw > 0.001F;
}

}  // namespace fsm
