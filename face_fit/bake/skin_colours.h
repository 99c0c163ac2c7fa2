#pragma once

#include "face_fit/bake/skin_texels.h"

namespace facefit {

/// How coloured a photo is: 0 for a grey one, 1 for one in colour, by the mean difference of the
/// channels where the skin's map shows it (`seen` near 1).
float Saturation(const fsm::Image& map, const FloatImage& seen);

/// How much of each texel is skin rather than hair, 0..1: hair is much darker than the median of
/// the face that is seen.
FloatImage SkinLikeness(const fsm::Image& map, const FloatImage& face_seen);

/// Removes bright strands of a fringe: going up from the brows, `likeness` ends where the hair
/// begins.
void CutAtHairline(const SkinTexels& texels, FloatImage& likeness);

/// How wrinkled the skin is: the median of the steps of brightness within some millimetres,
/// relative to the brightness; about 0.01 for smooth skin, 0.03 for old skin.
float Roughness(const fsm::Image& map, const FloatImage& face_seen);

}  // namespace facefit
