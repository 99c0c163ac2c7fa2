#pragma once

#include "face_fit/bake/skin_texels.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/image/raster.h"

namespace facefit {

/// Removes the shading of a smile from the cheeks of the skin's map, from the wings of the nose to
/// beside the chin: bulging cheeks shine and shade the skin below them. Variations of brightness
/// between the table's smile.shade.fine_mm and wide_mm are removed; pores and spots, which
/// are finer, stay. `share`: how much of them is removed, 0..1. `coverage`: how well the photo
/// shows each texel, 0..1.
void RemoveSmileShading(const ObservedHead& base, const SkinTexels& texels, const Mask& coverage,
                        float share, fsm::Image& map);

}  // namespace facefit
