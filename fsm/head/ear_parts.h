#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <utility>

#include "fsm/head/features.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/paint.h"

namespace fsm {

/// Adds both ears.
void BuildEars(const Features& features, const Palette& palette, HeadMesh& mesh);
/// Highest, lowest, foremost and hindmost point of the base head's left ear in its own plane.
std::array<std::pair<const char*, glm::vec3>, 4> EarLandmarks(const Features& features);

}  // namespace fsm
