#pragma once

#include "fsm/image/image.h"

namespace fsm {

// Tileable pictures; their bytes never change.

/// Makes 256 x 256 cells of noise: alpha has a cell's own value; blue the mean over 3 x 3 cells,
/// stretched to the same spread; red and green half the differences of blue along x and y, about
/// 128.
Image MakeNoiseTile();

/// Makes a tile of hair, 512 strands across, 256 texels along: the lightness of each hair in alpha,
/// of each lock of about 6 hairs in blue, both about 128 and changing slowly along the strand.
Image MakeStrandTile();

}  // namespace fsm
