#include "fsm/render/noise_tile.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fsm/base/random.h"

namespace fsm {
namespace {

constexpr int kNoiseCells = 256;  // a power of two
constexpr int kMask = kNoiseCells - 1;

std::size_t Cell(int x, int y) {
  return static_cast<std::size_t>((y & kMask) * kNoiseCells + (x & kMask));
}

}  // namespace

Image MakeNoiseTile() {
  const std::size_t count = static_cast<std::size_t>(kNoiseCells) * kNoiseCells;
  std::vector<int> own(count);
  for (std::size_t i = 0; i < count; ++i) own[i] = static_cast<int>(Scramble(i) >> 56);
  std::vector<int> smooth(count);
  for (int y = 0; y < kNoiseCells; ++y) {
    for (int x = 0; x < kNoiseCells; ++x) {
      int sum = 0;
      for (int k = 0; k < 9; ++k) sum += own[Cell(x + k % 3 - 1, y + k / 3 - 1)];
      // The mean of nine cells has a third of a cell's standard deviation; this restores it.
      smooth[Cell(x, y)] = std::clamp(128 + (sum - 9 * 128) / 4, 0, 255);
    }
  }
  Image tile{kNoiseCells, kNoiseCells, {}};
  for (int y = 0; y < kNoiseCells; ++y) {
    for (int x = 0; x < kNoiseCells; ++x) {
      const int right = (smooth[Cell(x + 1, y)] - smooth[Cell(x - 1, y)]) / 2;
      const int up = (smooth[Cell(x, y + 1)] - smooth[Cell(x, y - 1)]) / 2;
      for (const int value : {128 + right, 128 + up, smooth[Cell(x, y)], own[Cell(x, y)]}) {
        tile.rgba.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return tile;
}

Image MakeStrandTile() {
  constexpr int kStrandsAcross = 512, kStrandsAlong = 256;
  constexpr int kKnots = 16;  // linearly interpolated along a strand
  constexpr int kApart = kStrandsAlong / kKnots;
  constexpr std::uint64_t kHair = 41;
  constexpr std::uint64_t kLock = 42;
  Image tile{kStrandsAcross, kStrandsAlong, {}};
  const auto value = [](std::uint64_t series, int strand, int y) {
    const auto knot = [&](int k) {
      return Chance(series, static_cast<std::uint64_t>(strand * kKnots + k % kKnots));
    };
    const float t = static_cast<float>(y % kApart) / kApart;
    const float along = knot(y / kApart) * (1 - t) + knot(y / kApart + 1) * t;
    // Half of the value is constant along the strand.
    return 0.5f * along + 0.5f * Chance(series + 2, static_cast<std::uint64_t>(strand));
  };
  constexpr int kHairs = 6;
  constexpr int kLocks = (kStrandsAcross + kHairs - 1) / kHairs;
  for (int y = 0; y < kStrandsAlong; ++y) {
    for (int x = 0; x < kStrandsAcross; ++x) {
      const float t = static_cast<float>(x % kHairs) / kHairs;
      const int lock = x / kHairs;
      const float locks =
          value(kLock, lock, y) * (1 - t) + value(kLock, (lock + 1) % kLocks, y) * t;
      const auto byte = [](float light) { return static_cast<std::uint8_t>(255 * light); };
      tile.rgba.insert(tile.rgba.end(), {128, 128, byte(locks), byte(value(kHair, x, y))});
    }
  }
  return tile;
}

}  // namespace fsm
