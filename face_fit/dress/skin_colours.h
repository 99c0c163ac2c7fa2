#pragma once

#include <vector>

#include "face_fit/dress/field.h"

namespace facefit {

/// 0 for a grey photo, 1 for one in colour: by the mean difference of channels where the skin's map
/// shows the photo (`seen` near 1).
float Saturation(const fsm::Image& map, const FloatImage& seen);

/// How much of each texel is skin rather than hair over it, 0..1: hair is much darker than most of
/// the face that is seen.
FloatImage SkinLikeness(const fsm::Image& map, const FloatImage& face_seen);

/// Above the brows skin goes up to the hair and no further: bright strands of a fringe are no skin.
/// `up`: of each texel, millimetres above the line from which on hair may begin.
void EndAtHair(const std::vector<float>& up, FloatImage& likeness);

/// How much lines and folds are in the skin, as the median of brightness' steps within some
/// millimetres, by the brightness itself: about 0.01 for smooth skin, 0.03 for an old one.
float Roughness(const fsm::Image& map, const FloatImage& face_seen);

}  // namespace facefit
