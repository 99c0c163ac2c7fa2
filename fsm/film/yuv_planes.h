#pragma once

#include <cstdint>
#include <vector>

#include "fsm/image/image.h"

namespace fsm {

/// Converts a picture, composited over black, to planes of Y, Cb and Cr (4:2:0), 8 bit, limited
/// range, ITU-R BT.709. Odd sides are made even by repeating the last column or row. Resizes `out`
/// to 3/2 bytes per pixel.
void YuvPlanes(const Image& picture, std::vector<std::uint8_t>& out);

}  // namespace fsm
