#pragma once

#include "face_fit/bake/skin_texels.h"

namespace facefit {

// `coverage`: how well the photo shows each texel of a map, 0..1; only texels near 1 are used.

/// Returns the saturation of a photo, 0 = grey, 1 = coloured, by the mean difference of its
/// channels.
float Saturation(const fsm::Image& map, const Mask& coverage);

/// Returns the gain of each channel that moves a colour from one light to another: the ratio of
/// `to` to `from`, colours of similar skin in either light, clamped to light_gain of the table.
glm::vec3 LightGain(glm::vec3 to, glm::vec3 from);

/// Returns how much of each texel is skin rather than hair, 0..1: hair is much darker than the
/// face's median.
Mask SkinLikeness(const fsm::Image& map, const Mask& face_coverage);

/// Returns the likeness without bright strands of a fringe: going up from the brows, skin ends
/// where hair begins. `brows_y_mm`: height of their upper ends.
Mask CutAtHairline(const SkinTexels& texels, float brows_y_mm, Mask likeness);

/// Returns how wrinkled the skin is: the median difference of brightness between a fine and a wide
/// average, divided by the brightness; about 0.01 for smooth skin, 0.03 for old skin.
float Roughness(const fsm::Image& map, const Mask& face_coverage);

}  // namespace facefit
