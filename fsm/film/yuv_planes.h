#pragma once

#include <cstdint>
#include <vector>

#include "fsm/image/image.h"

namespace fsm {

/// A picture on black as an encoder takes it: planes of Y, Cb and Cr (4:2:0), 8 bit, limited range,
/// ITU-R BT.709. Odd sides are made even by repeating the last column and row. `out` is resized to
/// 3/2 of the pixels.
void YuvPlanes(const Image& picture, std::vector<std::uint8_t>& out);

}  // namespace fsm
