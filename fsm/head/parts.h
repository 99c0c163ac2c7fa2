#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <utility>

#include "fsm/head/anatomy.h"
#include "fsm/head/features.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/paint.h"
#include "fsm/head/skin_mesh.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The parts beside the skin. Each adds its vertices for both sides. Cloth and lashes move
/// as skin and must be added before the rigid parts, so that such vertices stay one run.
void BuildCloth(const Features& features, const Palette& palette, HeadMesh& mesh);
/// Tones the skin under the brows and returns their hairs, which are painted on it.
std::vector<SkinHair> BuildBrows(const SkinFront& front, const Identity& identity, HeadMesh& mesh);
/// The furrow over each upper lid, as strokes painted on the skin.
std::vector<SkinHair> BuildLidFolds(const SkinFront& front, const EyeAnatomy& eye,
                                    const Features& features);
/// `of_photo`: those of the upper lids alone, with how dark they are in HeadMesh::opacity.
void BuildLashes(const EyeAnatomy& eye, const Identity& identity, bool of_photo, HeadMesh& mesh);

void BuildEyes(const EyeAnatomy& eye, const Features& features, const Palette& palette,
               HeadMesh& mesh);
void BuildTeeth(const MouthAnatomy& mouth, const Features& features, const Palette& palette,
                HeadMesh& mesh);
void BuildTongue(const MouthAnatomy& mouth, const Features& features, const Palette& palette,
                 HeadMesh& mesh);
/// Fills the incisors of `topology.mouth`: the middle of either row of teeth at its edge, and of
/// the upper one at its root. `rest` and `bone` of all its vertices.
void FindIncisors(std::span<const glm::vec3> rest, std::span<const Bone> bone,
                  HeadTopology& topology);
void BuildEars(const Features& features, const Palette& palette, HeadMesh& mesh);
/// Highest, lowest, foremost and hindmost point of the base head's left ear in its own plane.
std::array<std::pair<const char*, glm::vec3>, 4> EarLandmarks(const Features& features);

}  // namespace fsm
