#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

void BuildTeeth(const MouthAnatomy& mouth, const Identity& identity, HeadMesh& mesh);
void BuildTongue(const MouthAnatomy& mouth, const Identity& identity, HeadMesh& mesh);
/// Finds the incisors of `topology.mouth`: the middle of each row of teeth at its edge, and of the
/// upper row at its root. `rest` and `bone` are those of all vertices.
void FindIncisors(std::span<const glm::vec3> rest, std::span<const Bone> bone,
                  HeadTopology& topology);

}  // namespace fsm
