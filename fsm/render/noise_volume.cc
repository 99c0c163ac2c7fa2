#include "fsm/render/noise_volume.h"

#include <glm/common.hpp>

namespace fsm {
namespace {

/// A well mixed number for a cell; the constants are those of Steele's SplitMix64.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

int Value(int x, int y, int z) {
  constexpr int kMask = kNoiseCells - 1;
  const int cell = ((z & kMask) * kNoiseCells + (y & kMask)) * kNoiseCells + (x & kMask);
  return static_cast<int>(Mix(static_cast<std::uint64_t>(cell)) >> 56);
}

}  // namespace

std::vector<std::uint8_t> MakeNoiseVolume() {
  std::vector<std::uint8_t> volume;
  volume.reserve(static_cast<std::size_t>(kNoiseCells) * kNoiseCells * kNoiseCells * 4);
  const auto slope = [](int after, int before) {
    return static_cast<std::uint8_t>(128 + (after - before) / 2);
  };
  for (int z = 0; z < kNoiseCells; ++z) {
    for (int y = 0; y < kNoiseCells; ++y) {
      for (int x = 0; x < kNoiseCells; ++x) {
        volume.push_back(slope(Value(x + 1, y, z), Value(x - 1, y, z)));
        volume.push_back(slope(Value(x, y + 1, z), Value(x, y - 1, z)));
        volume.push_back(slope(Value(x, y, z + 1), Value(x, y, z - 1)));
        volume.push_back(static_cast<std::uint8_t>(Value(x, y, z)));
      }
    }
  }
  return volume;
}

float NoiseAt(const glm::vec3& cells) {
  const glm::vec3 corner = glm::floor(cells);
  const glm::vec3 inside = cells - corner;
  float sum = 0;
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1;
    const int y = i >> 1 & 1;
    const int z = i >> 2;
    const float weight = (x ? inside.x : 1 - inside.x) * (y ? inside.y : 1 - inside.y) *
                         (z ? inside.z : 1 - inside.z);
    sum += weight *
           static_cast<float>(Value(static_cast<int>(corner.x) + x, static_cast<int>(corner.y) + y,
                                    static_cast<int>(corner.z) + z));
  }
  return sum / 255 - 0.5F;
}

}  // namespace fsm
