#pragma once

#include <span>

#include "fsm/render/skin_texture.h"
#include "fsm/rig/head_asset.h"

namespace fsm {

/// Draws hairs into the tint, each a bent line that ends in a point.
void PaintHairs(std::span<const SkinHair> hairs, SkinTexture& out);

}  // namespace fsm
