#pragma once

#include "face_fit/bake/skin_texels.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// Removes the shading of a smile from the cheeks of the skin's map, from the wings of the nose to
/// beside the chin. Cheeks that bulge shine, and the skin below them lies in shade: brightness that
/// varies over fine_texels to wide_texels of the table is replaced by what varies over more. Pores
/// and spots are finer and stay. `smile`: how much of it, 0..1. `coverage`: of each texel, how well
/// the photo shows it.
void RemoveSmileShading(const ObservedHead& base, const SkinTexels& texels,
                        const FloatImage& coverage, float smile, fsm::Image& map);

/// Gives back to skin that was smoothed the grain that the cheek has above it and farther out.
/// `smooth`: how much of its own each texel of the map lost, 0..1.
void GrainFromCheeks(const FloatImage& smooth, fsm::Image& map);

}  // namespace facefit
