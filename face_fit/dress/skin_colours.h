#pragma once

#include "face_fit/dress/field.h"

namespace facefit {

/// 0 for a grey photo, 1 for one in colour: by the mean difference of channels where the skin's map
/// shows the photo (`seen` near 1).
float Saturation(const fsm::Image& map, const Field& seen);

/// How much of each texel is skin rather than hair over it, 0..1: hair is much darker than most of
/// the face that is seen.
Field SkinLikeness(const fsm::Image& map, const Field& face_seen);

}  // namespace facefit
