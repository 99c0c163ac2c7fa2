#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <utility>

#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

void BuildEars(const Identity& identity, MeshBuilder& mesh);
/// Returns the highest, lowest, foremost and rearmost point of the base head's left ear in its own
/// plane: landmarks of Farkas' length and breadth of the ear.
std::array<std::pair<const char*, glm::vec3>, 4> EarLandmarks(const Features& features);

}  // namespace fsm
