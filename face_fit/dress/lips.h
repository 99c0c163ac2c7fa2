#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "fsm/image/image.h"

namespace facefit {

/// A smile draws lips thin: towards its corners a photo shows little or nothing of their red, and
/// where the mouth is brought back to rest skin would be seen there. What is less red than most of
/// the lips takes their hue and their darkness against the skin beside them. `within`: of each
/// texel of `map`, millimetres within the border of the lips, negative outside; texels farther from
/// it than 8 mm are not looked at. Lips that are no redder than skin, as in a grey photo, stay.
void RedLips(const std::vector<float>& within, fsm::Image& map);

}  // namespace facefit
