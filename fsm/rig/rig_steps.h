#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "fsm/rig/rig_data.h"
#include "fsm/rig/steps.h"

namespace fsm {

/// Which vertices the jaw, a bone, the tongue and the step kNormals move: found once from a rig.
struct MovedVertices {
  explicit MovedVertices(const RigData& data);
  std::vector<std::uint32_t> jawed, rigid, tongue, soft;
};

/// What the steps read and write while they make vertices of one state.
struct StepWork {
  step::StepState state;
  std::span<const float> strengths;  ///< of each channel
  std::span<const glm::vec3> swings;
  std::span<glm::vec3> position;
  std::span<glm::vec3> normal;  ///< empty where only steps that shape the skin are taken
};

/// Takes one step on the processor.
void Take(RigStep step, const RigData& data, const MovedVertices& moved, StepWork& work);

/// The name of a step, as `fsm --describe` shows it and as rig_kernels.glsl has it after STEP_.
std::string_view NameOf(RigStep step);

/// Whether the jaw carries a vertex as skin.
inline bool MovesWithJaw(const RigData& data, std::uint32_t vertex) {
  return data.bone[vertex] == Bone::kSkin && data.weights[vertex].jaw > 0.001F;
}

}  // namespace fsm
