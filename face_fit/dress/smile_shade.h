#pragma once

#include "face_fit/dress/field.h"
#include "face_fit/dress/skin_places.h"
#include "face_fit/fit/base_head.h"

namespace facefit {

/// Takes the shading of a smile out of the cheeks of the skin's map, from the wings of the nose to
/// beside the chin: a bulge that shines and the shade below it are steps of light over a finger's
/// width, so what varies over 3 to 12 mm is evened out towards what varies over more; finer
/// detail, pores and spots, stays. `smile`: how much of it, 0..1. `seen`: of each texel, how well
/// the photo shows it.
void EvenSmileShade(const BaseHead& base, const SkinPlaces& places, const FloatImage& seen,
                    float smile, fsm::Image& map);

/// Gives back to skin that was smoothed the grain that the cheek has above it and farther out.
/// `smooth`: how much of its own each texel of the map lost, 0..1.
void GrainFromCheeks(const FloatImage& smooth, fsm::Image& map);

}  // namespace facefit
