#pragma once

#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

/// Adds grain, of pores, hair or beard, to what was filled in and is too smooth. It is taken from
/// the place mirrored at the edge of the known pixels. `weight`: 1 where a pixel was known, 0 where
/// it was filled in; `where`: how much grain is added, 0..1; `reach`: pixels over which brightness
/// varies as grain; grain is carried up to eight times as far.
void AddGrain(const FloatImage& weight, const FloatImage& where, int reach, fsm::Image& image);

}  // namespace facefit
