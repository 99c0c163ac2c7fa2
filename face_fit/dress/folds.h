#pragma once

#include "face_fit/dress/field.h"
#include "face_fit/find/face_finder.h"

namespace facefit {

/// Takes out of a photo of a smile the folds that the smile made from the wings of the nose past
/// the corners of the mouth, whose dark would stay when the face is at rest: valleys narrower than
/// a finger are filled by what lies beside them. `smile`: how much of them goes, 0..1. Returned:
/// how much of each pixel is filled and so has lost its grain, 0..1.
FloatImage FillSmileFolds(const FoundFace& face, float smile, float pixels_per_mm,
                          fsm::Image& photo);

}  // namespace facefit
