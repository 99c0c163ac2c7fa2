#pragma once

#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/paint.h"
#include "fsm/head/skin_mesh.h"

namespace fsm {

/// Tones the skin under the brows and returns their hairs, which are to be painted on it.
std::vector<SkinHair> BuildBrows(const SkinFront& front, const Identity& identity, HeadMesh& mesh);
/// Returns the fold of each upper lid, as strokes to be painted on the skin.
std::vector<SkinHair> BuildLidFolds(const SkinFront& front, const EyeAnatomy& eye,
                                    const Identity& identity);
/// Returns the hairs of a shaved beard, as dense as `painter` tones the skin.
std::vector<SkinHair> BuildStubble(const SkinFront& front, const SkinPainter& painter,
                                   const Identity& identity);

}  // namespace fsm
