#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/skin_mesh.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// The units of tables/action_units.txt, both sides alike. Made at the first call; thread: any.
const UnitTable& BuiltInUnits();

// Parts of a built-in head's rig, baked from its anatomy. `weights` are those of the vertices that
// come first in `rest`: skin, and what moves as skin does.

/// What each of the 17 mouth parameters displaces.
std::vector<Channel> MouthChannels(const MouthAnatomy& mouth, std::span<const BakeWeights> weights);
/// `eyes`: where the right and the left eye sit.
LidRig BakeLids(const EyeAnatomy& eye, const Sided<EyeTransform>& eyes,
                std::span<const glm::vec3> rest, std::span<const BakeWeights> weights);
/// `upper`, `lower`: the arches of this head.
TeethRig BakeTeeth(const ToothArch& upper, const ToothArch& lower, std::span<const glm::vec3> rest,
                   std::span<const BakeWeights> weights);
LipRig BakeLips(const MouthSlit& mouth, std::span<const BakeWeights> weights);

}  // namespace fsm
