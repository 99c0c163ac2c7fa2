#pragma once

#include "fsm/image/image.h"

namespace fsm {

// Tileable pictures, always of the same bytes.

/// Noise, 256 x 256: every cell's own value in alpha, a mean over 3 x 3 cells, stretched to the
/// same spread, in blue, and half the difference of that along x and y in red and green, both about
/// 128.
Image MakeNoiseTile();

/// Strands, 512 across and 256 along them: how light each hair is in alpha, each lock of some 6
/// hairs in blue, both about 128 and changing slowly along the strand; red and green are 128.
Image MakeStrandTile();

}  // namespace fsm
