#include "fsm/render/samples.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace fsm {
namespace {

/// The average of every 2 x 2 of two rows of samples that follow each other, rounded to the
/// nearest. Bytes 0 and 2 of a sample are added in one word, 1 and 3 in another, with room for the
/// carry.
void AverageRow(const std::uint32_t* samples, std::size_t row, std::uint8_t* rgba) {
  constexpr std::uint32_t kEven = 0x00ff00ff;
  constexpr std::uint32_t kHalf = 0x00020002;
  for (std::size_t x = 0; x < row; x += 2) {
    const std::uint32_t four[] = {samples[x], samples[x + 1], samples[row + x],
                                  samples[row + x + 1]};
    std::uint32_t even = kHalf, odd = kHalf;
    for (const std::uint32_t sample : four) {
      even += sample & kEven;
      odd += (sample >> 8) & kEven;
    }
    const std::uint32_t average = ((even >> 2) & kEven) | (((odd >> 2) & kEven) << 8);
    std::memcpy(rgba + 2 * x, &average, sizeof(average));
  }
}

/// Likewise of every 4 x 4 of four rows, the inner samples three times as heavy as the outer ones
/// in either direction: pixels share what lies between them. `sums`: room for 2 * row words.
void SoftRow(const std::array<const std::uint32_t*, 4>& rows, std::size_t row, std::uint32_t* sums,
             std::uint8_t* rgba) {
  constexpr std::uint32_t kEven = 0x00ff00ff;
  constexpr std::uint32_t kHalf = 0x00200020;
  std::uint32_t* even = sums;
  std::uint32_t* odd = sums + row;
  const auto weigh = [](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    return a + d + 3 * (b + c);  // up to 8 times a byte, then 64 times: 16 bits hold it
  };
  for (std::size_t x = 0; x < row; ++x) {
    const std::uint32_t s[] = {rows[0][x], rows[1][x], rows[2][x], rows[3][x]};
    even[x] = weigh(s[0] & kEven, s[1] & kEven, s[2] & kEven, s[3] & kEven);
    odd[x] =
        weigh((s[0] >> 8) & kEven, (s[1] >> 8) & kEven, (s[2] >> 8) & kEven, (s[3] >> 8) & kEven);
  }
  for (std::size_t x = 0; x < row; x += 2) {
    const std::size_t before = x > 0 ? x - 1 : x, after = std::min(x + 2, row - 1);
    const std::uint32_t e = weigh(even[before], even[x], even[x + 1], even[after]) + kHalf;
    const std::uint32_t o = weigh(odd[before], odd[x], odd[x + 1], odd[after]) + kHalf;
    const std::uint32_t average = ((e >> 6) & kEven) | (((o >> 6) & kEven) << 8);
    std::memcpy(rgba + 2 * x, &average, sizeof(average));
  }
}

}  // namespace

void AverageSamples(const SampleRows& samples, int first, int rows, bool soft, std::uint8_t* rgba) {
  const std::size_t row = samples.row;
  std::vector<std::uint32_t> sums(soft ? 2 * row : 0);
  const auto at = [&](int k) {
    const int inside = std::clamp(k, samples.from, samples.to) - samples.from;
    return samples.first + row * static_cast<std::size_t>(inside);
  };
  for (int k = rows - 1; k >= 0; --k, rgba += row * 2) {
    const int low = (first + k) * kSamplesAlong;
    if (soft) {
      SoftRow({at(low - 1), at(low), at(low + 1), at(low + 2)}, row, sums.data(), rgba);
    } else {
      AverageRow(at(low), row, rgba);
    }
  }
}

void Unmultiply(Image& image) {
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const unsigned a = image.rgba[i + 3];
    if (a == 0 || a == 255) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned whole = (image.rgba[i + c] * 255U + a / 2) / a;
      image.rgba[i + c] = static_cast<std::uint8_t>(std::min(whole, 255U));
    }
  }
}

}  // namespace fsm
