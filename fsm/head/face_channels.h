#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/skin_mesh.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// Returns the units of tables/action_units.txt without asymmetry. Made on first call; thread: any.
const UnitTable& BuiltInUnits();

// The functions below bake parts of a built-in head's rig from its anatomy. `weights`: of each
// vertex of `rest`.

/// Returns the displacements of each of the 17 mouth parameters.
std::vector<Channel> MouthChannels(const MouthAnatomy& mouth, std::span<const BakeWeights> weights);
/// `eyes`: the placement of the right and the left eye.
LidRig BakeLids(const EyeAnatomy& eye, const Sided<EyeTransform>& eyes,
                std::span<const glm::vec3> rest, std::span<const BakeWeights> weights);
/// `upper`, `lower`: the dental arches of this head.
TeethRig BakeTeeth(const ToothArch& upper, const ToothArch& lower, std::span<const glm::vec3> rest,
                   std::span<const BakeWeights> weights);
LipRig BakeLips(std::span<const BakeWeights> weights);

}  // namespace fsm
