#pragma once

#include <span>

#include "fsm/render/skin_texture.h"
#include "fsm/rig/head_asset.h"

namespace fsm {

/// Draws hairs into the tint texture, each as a bent line that tapers to a point.
void PaintHairs(std::span<const SkinHair> hairs, SkinTexture& out);

}  // namespace fsm
