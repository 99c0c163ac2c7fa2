#pragma once

#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/paint.h"
#include "fsm/head/skin_mesh.h"

namespace fsm {

/// Tones the skin under the brows and returns their hairs, which are painted on it.
std::vector<SkinHair> BuildBrows(const SkinFront& front, const Identity& identity, HeadMesh& mesh);
/// The furrow over each upper lid, as strokes painted on the skin.
std::vector<SkinHair> BuildLidFolds(const SkinFront& front, const EyeAnatomy& eye,
                                    const Identity& identity);
/// A shaved beard's hairs, painted on the skin as densely as `painter` tones it.
std::vector<SkinHair> BuildStubble(const SkinFront& front, const SkinPainter& painter,
                                   const Identity& identity);

}  // namespace fsm
