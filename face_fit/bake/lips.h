#pragma once

#include "face_fit/bake/skin_texels.h"

namespace facefit {

/// Restores the red of lips that a smile has stretched: a photo shows little of it towards the
/// corners, and a mouth brought back to rest would show skin there. Texels of the lips less red
/// than most take the hue of the lips, and their darkness relative to the skin beside them. Changes
/// nothing if lips are no redder than skin, as in a grey photo.
void RestoreLipColour(const SkinTexels& texels, fsm::Image& map);

/// Draws the dark lip seam of lips that were apart, reddish if the photo has colour.
/// `saturation`: of the photo, 0 = grey, 1 = coloured.
void DrawLipSeam(const SkinTexels& texels, float saturation, fsm::Image& map);

}  // namespace facefit
