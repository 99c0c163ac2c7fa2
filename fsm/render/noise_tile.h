#pragma once

#include <cstdint>
#include <vector>

namespace fsm {

/// Cells along each side of the noise tile; a power of two.
inline constexpr int kNoiseCells = 256;

/// A tileable picture of noise, kNoiseCells^2 RGBA bytes: every cell's own value in alpha, a mean
/// over 3 x 3 cells, stretched to the same spread, in blue, and half the difference of that along x
/// and y in red and green, both about 128. Always the same bytes.
std::vector<std::uint8_t> MakeNoiseTile();

/// Texels of the strand tile across and along the strands.
inline constexpr int kStrandsAcross = 512;
inline constexpr int kStrandsAlong = 256;

/// A tileable picture of strands, kStrandsAcross x kStrandsAlong RGBA bytes about 128: how light
/// each hair is in alpha, each lock of some 6 hairs in blue, both changing slowly along the strand;
/// red and green are 128. Always the same bytes.
std::vector<std::uint8_t> MakeStrandTile();

}  // namespace fsm
