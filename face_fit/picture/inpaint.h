#pragma once

#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

/// Fills what has no weight with the colours around it, which are the wider averages the farther
/// away they are (push and pull through a pyramid of halved pictures; Gortler, Grzeszczuk, Szeliski
/// and Cohen, The Lumigraph, 1996). Full weight stays as it is. `weight`: 0..1, as large as
/// `image`.
void PushPullInpaint(fsm::Image& image, const FloatImage& weight);

}  // namespace facefit
