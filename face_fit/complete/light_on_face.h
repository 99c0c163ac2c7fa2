#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"
#include "fsm/head/face_light.h"

namespace facefit {

/// Estimates the light that falls on the skin of a face, and the mean colour of that skin, from the
/// pixels of the figure that show the front of the face.
fsm::FaceLight LightOnFace(const FittedHead& fitted, const FigureCutout& figure);

}  // namespace facefit
