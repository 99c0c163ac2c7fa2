#pragma once

#include "face_fit/bake/skin_map.h"
#include "face_fit/bake/skin_texels.h"
#include "face_fit/fit/side_view.h"

namespace facefit {

/// Blends a view from the side over skin that the first photo saw at a grazing angle or not at all,
/// in the light of the first photo. What either photo shows between lids and between parted lips is
/// left out. `front`: the texels in the first photo.
void BlendSideView(const FittedHead& fitted, const SideView& view, const SkinTexels& front,
                   SkinMap& map);

}  // namespace facefit
