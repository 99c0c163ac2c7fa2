#pragma once

#include <vector>

#include "face_fit/dress/field.h"

namespace facefit {

/// Where one side of the skin's map was not seen it takes what the other side shows, mirrored and
/// brought into its own light: colours are multiplied by what the two sides differ by around there,
/// where both were seen. Without that a wing of the nose or an edge of the jaw shines in the light
/// of the other cheek.
/// `skin`: texels within neither eyes nor mouth, which differ too much from side to side.
/// `seen`: how well each texel was seen, 0..1; grows where something was taken over.
void TakeFromOtherSide(const std::vector<bool>& skin, fsm::Image& map, FloatImage& seen);

}  // namespace facefit
