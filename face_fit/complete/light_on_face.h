#pragma once

#include "face_fit/fit/fitted_head.h"
#include "fsm/head/face_light.h"
#include "fsm/image/image.h"

namespace facefit {

/// Estimates the light that falls on the skin of a face, and the mean colour of that skin, from the
/// pixels of the figure that show the front of the face. `colours`: of the figure.
fsm::FaceLight LightOnFace(const FittedHead& fitted, const fsm::Image& colours);

}  // namespace facefit
