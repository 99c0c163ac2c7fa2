#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// The figure's colours with the face taken out and the gap filled from around it: this shows
/// beside the face when the head turns.
fsm::Image BehindFace(const FittedHead& fitted, const FigureCutout& figure);

}  // namespace facefit
