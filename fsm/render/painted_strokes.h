#pragma once

#include <span>

#include "fsm/render/skin_texture.h"
#include "fsm/rig/head_asset.h"

namespace fsm {

/// Draws strokes into the tint texture.
void PaintStrokes(std::span<const SkinStroke> strokes, SkinTexture& out);

}  // namespace fsm
