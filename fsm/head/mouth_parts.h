#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

void BuildTeeth(const MouthAnatomy& mouth, const Identity& identity, HeadMesh& mesh);
void BuildTongue(const MouthAnatomy& mouth, const Identity& identity, HeadMesh& mesh);
/// Fills the incisors of `topology.mouth`: the middle of either row of teeth at its edge, and of
/// the upper one at its root. `rest` and `bone` of all its vertices.
void FindIncisors(std::span<const glm::vec3> rest, std::span<const Bone> bone,
                  HeadTopology& topology);

}  // namespace fsm
