#pragma once

#include "face_fit/dress/field.h"

namespace facefit {

/// How much of each pixel a figure covers: 1 within, 0 outside, between at soft edges and strands
/// of hair. `person` says roughly where it is, 0..1; where that is sure, it stays.
FloatImage Matte(const fsm::Image& photo, const FloatImage& person);

/// The figure's own colours: what shines in from behind it is taken out of its edge, and they go on
/// beyond it.
fsm::Image WithoutBackground(const fsm::Image& photo, const FloatImage& opacity);

}  // namespace facefit
