#pragma once

#include "face_fit/bake/skin_texels.h"

namespace facefit {

/// Reddens lips that a smile has drawn thin: towards the corners a photo shows little of their red,
/// and where the mouth is brought back to rest skin would show there. Texels less red than most of
/// the lips take their hue, and their darkness relative to the skin beside them; texels far
/// outside the lips are ignored. Nothing changes if lips are no redder than skin, as in a grey
/// photo.
void RestoreLipColour(const SkinTexels& texels, fsm::Image& map);

}  // namespace facefit
