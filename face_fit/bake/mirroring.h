#pragma once

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

/// Completes each side of the skin's map from the mirror image of the other, multiplied by the
/// ratio of both sides' light nearby, where both were seen: a wing of the nose would otherwise show
/// the light of the other cheek. `outside_openings`: 0 in eyes and mouth, which differ too
/// much from side to side, and are not copied. `coverage`: how well the photo shows each texel,
/// 0..1; raised where something was copied.
void CompleteByMirroring(const Mask& outside_openings, fsm::Image& map, Mask& coverage);

}  // namespace facefit
