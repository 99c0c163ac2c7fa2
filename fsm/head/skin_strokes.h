#pragma once

#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/head/paint.h"
#include "fsm/head/skin_mesh.h"

namespace fsm {

/// Tones the skin under the brows and returns their hairs.
std::vector<SkinStroke> BuildBrows(const SkinFront& front, const Identity& identity,
                                   MeshBuilder& mesh);
/// Returns the fold of each upper lid, as strokes to be painted on the skin.
std::vector<SkinStroke> BuildLidFolds(const SkinFront& front, const EyeAnatomy& eye,
                                      const Identity& identity);
/// Returns the hairs of a shaved beard, as dense as `painter` tones the skin.
std::vector<SkinStroke> BuildStubble(const SkinFront& front, const SkinPainter& painter,
                                     const Identity& identity);

}  // namespace fsm
