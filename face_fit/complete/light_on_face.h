#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"
#include "fsm/head/face_light.h"

namespace facefit {

/// The light that falls on the skin of a face, and the usual colour of that skin.
fsm::FaceLight LightOnFace(const FittedHead& fitted, const FigureCutout& figure);

}  // namespace facefit
