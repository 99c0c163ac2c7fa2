#pragma once

#include <vector>

#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

/// Completes one side of the skin's map from the other, mirrored. Colours are multiplied by the
/// ratio of both sides' light nearby, where both were seen: otherwise a wing of the nose or an edge
/// of the jaw would shine in the light of the other cheek. `skin`: texels within neither eyes nor
/// mouth, which differ too much from side to side. `coverage`: how well the photo shows each
/// texel, 0..1; grows where something was taken over.
void CompleteByMirroring(const std::vector<bool>& skin, fsm::Image& map, FloatImage& coverage);

}  // namespace facefit
