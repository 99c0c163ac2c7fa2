#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "fsm/head/anatomy.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

void BuildTeeth(const MouthAnatomy& mouth, const Identity& identity, MeshBuilder& mesh);
void BuildTongue(const MouthAnatomy& mouth, const Identity& identity, MeshBuilder& mesh);
/// Finds the middle of each row of teeth at its edge, and of the upper row at its root; nothing in
/// a head without teeth. `rest` and `bone` are those of all vertices.
std::optional<Incisors> FindIncisors(std::span<const glm::vec3> rest, std::span<const Bone> bone,
                                     const HeadSurface& surface);

}  // namespace fsm
