#pragma once

#include "face_fit/find/network/face_finder.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// Fills the folds that a smile makes from the wings of the nose past the corners of the mouth:
/// their dark would stay in the skin when the face is at rest. Dark valleys narrower than a finger
/// take the colour of what lies beside them. `smile`: how much of them is filled, 0..1. Returns for
/// each pixel how much it was filled and so lost its grain, 0..1.
FloatImage FillSmileFolds(const FoundFace& face, float smile, float pixels_per_mm,
                          fsm::Image& photo);

}  // namespace facefit
