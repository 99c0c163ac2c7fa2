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

/// A well mixed number for any number (Steele's SplitMix64).
inline std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// The i-th of a fixed series of numbers in 0..1; each `series` is another.
inline float Chance(std::uint64_t series, std::uint64_t i) {
  return static_cast<float>(Mix(series << 40 ^ i) >> 40) * 0x1p-24F;
}

}  // namespace fsm
