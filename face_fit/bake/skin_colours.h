#pragma once

#include "face_fit/bake/skin_texels.h"

namespace facefit {

// `coverage`: how well the photo shows each texel of a map, 0..1; only those near 1 are asked.

/// How coloured a photo is: 0 for a grey one, 1 for one in colour, by the mean difference of the
/// channels.
float Saturation(const fsm::Image& map, const FloatImage& coverage);

/// How much of each texel is skin rather than hair, 0..1: hair is much darker than the median of
/// the face.
FloatImage SkinLikeness(const fsm::Image& map, const FloatImage& face_coverage);

/// The likeness without bright strands of a fringe: going up from the brows, it ends where the hair
/// begins.
FloatImage CutAtHairline(const SkinTexels& texels, FloatImage likeness);

/// How wrinkled the skin is: the median of the steps of brightness within some millimetres,
/// relative to the brightness; about 0.01 for smooth skin, 0.03 for old skin.
float Roughness(const fsm::Image& map, const FloatImage& face_coverage);

}  // namespace facefit
