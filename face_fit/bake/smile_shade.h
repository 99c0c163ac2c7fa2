#pragma once

#include "face_fit/bake/skin_texels.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// Removes the shading of a smile from the cheeks of the skin's map, from the wings of the nose to
/// beside the chin: bulging cheeks shine and shade the skin below them. Variations of brightness
/// between the table's smile.shade.fine_mm and wide_mm are removed; pores and spots, which
/// are finer, stay. `smile`: share that is removed, 0..1. `coverage`: how well the photo shows each
/// texel, 0..1.
void RemoveSmileShading(const ObservedHead& base, const SkinTexels& texels, const Mask& coverage,
                        float smile, fsm::Image& map);

/// Restores the grain of smoothed skin from the cheek above it and farther out. `lost`: share of
/// its grain that each texel lost, 0..1.
void GrainFromCheeks(const Mask& lost, fsm::Image& map);

}  // namespace facefit
