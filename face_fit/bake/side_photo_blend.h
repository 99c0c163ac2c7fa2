#pragma once

#include "face_fit/bake/skin_map.h"
#include "face_fit/bake/skin_texels.h"
#include "face_fit/side/use_side_photos.h"

namespace facefit {

/// Blends a view from the side over skin that the front photo saw at a grazing angle or not at all,
/// in the light of the front photo. What either photo shows between lids and between parted lips is
/// left out. `front`: what the front photo shows of `texels`.
void BlendSidePhoto(const FittedHead& fitted, const PosedSidePhoto& view, const SkinTexels& texels,
                    const TexelProjections& front, SkinMap& map);

}  // namespace facefit
