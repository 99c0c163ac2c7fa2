#pragma once

#include "fsm/image/image.h"

namespace fsm {

/// Returns the picture at a smaller or equal size, at least 1 x 1: each pixel is the mean of the
/// area it covers. Colours are averaged without regard to alpha.
Image Shrunk(const Image& image, int width, int height);
/// Returns half the width and height, rounded down to at least 1: each pixel is the mean of 2 x 2.
Image Halved(const Image& image);
/// Halves a picture until neither side is longer than `side`.
void HalveUntil(Image& image, int side);

}  // namespace fsm
