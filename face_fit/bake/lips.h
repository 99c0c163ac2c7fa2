#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "fsm/image/image.h"

namespace facefit {

/// Reddens lips that a smile has drawn thin: towards the corners a photo shows little of their red,
/// and where the mouth is brought back to rest skin would show there. Texels less red than most of
/// the lips take their hue, and their darkness relative to the skin beside them. `within`: for each
/// texel of `map`, millimetres within the border of the lips, negative outside; texels more than 8
/// mm away are ignored. Nothing changes if lips are no redder than skin, as in a grey photo.
void RedLips(const std::vector<float>& within, fsm::Image& map);

}  // namespace facefit
