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

// What the rig of a built-in head must know, from its anatomy. `weights`, and `rest` with it, begin
// with the skin of a head and what is moved as skin.

/// What each of the 17 mouth parameters displaces.
std::vector<Channel> MouthChannels(const MouthAnatomy& mouth, std::span<const BakeWeights> weights);
/// `eyes`: where the right and the left eye sit.
LidRig BakeLids(const EyeAnatomy& eye, const Sided<EyeTransform>& eyes,
                std::span<const glm::vec3> rest, std::span<const BakeWeights> weights);
/// Arches where the head has them.
TeethRig BakeTeeth(const ToothArch& upper, const ToothArch& lower, std::span<const glm::vec3> rest,
                   std::span<const BakeWeights> weights);
LipRig BakeLips(const MouthSlit& mouth, std::span<const BakeWeights> weights);

}  // namespace fsm
