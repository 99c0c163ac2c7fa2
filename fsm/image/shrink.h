#pragma once

#include "fsm/image/image.h"

namespace fsm {

/// The same picture at a size that is no larger, 1 x 1 or more: every pixel is the mean of what it
/// covers. Colours are taken as they are, whatever their opacity.
Image Shrunk(const Image& image, int width, int height);
/// At half the width and height, rounded down but 1 or more: every pixel is the mean of 2 x 2.
Image Halved(const Image& image);

}  // namespace fsm
