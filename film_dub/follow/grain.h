#pragma once

#include "face_fit/image/plane.h"
#include "fsm/image/image.h"

namespace filmdub {

/// How much the pixels of two pictures of a film differ that follow each other, where nothing
/// moves: the deviation of the brightness (0..1) within small squares of a part, of those that
/// differ least (a quarter of them); 0 where the part has none. It is of one picture's noise.
/// REQUIRES: the same size.
double GrainBetween(const fsm::Image& a, const fsm::Image& b, const facefit::Box2& part);

}  // namespace filmdub
