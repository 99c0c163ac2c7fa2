#include "fsm/render/samples.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace fsm {
namespace {

/// Averages each 2 x 2 block of two consecutive rows of samples, rounded to nearest. Bytes 0 and 2
/// of a sample are added in one word, 1 and 3 in another, which leaves room for the carry.
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

/// Averages each 4 x 4 block of four rows, with three times the weight for the inner samples in
/// either direction, so neighbouring pixels share samples. `sums`: space for 4 * (row + 2) numbers.
void SoftRow(const std::array<const std::uint32_t*, 4>& rows, std::size_t row, std::uint16_t* sums,
             std::uint8_t* rgba) {
  const auto bytes = [&rows](std::size_t k) {
    return reinterpret_cast<const std::uint8_t*>(rows[k]);
  };
  const std::uint8_t *below = bytes(0), *low = bytes(1), *high = bytes(2), *above = bytes(3);
  std::uint16_t* inside = sums + 4;  // one more sample at either end
  for (std::size_t i = 0; i < 4 * row; ++i) {
    inside[i] = static_cast<std::uint16_t>(below[i] + above[i] + 3 * (low[i] + high[i]));
  }
  std::copy_n(inside, 4, sums);
  std::copy_n(inside + 4 * row - 4, 4, inside + 4 * row);
  for (std::size_t i = 0; i < 2 * row; i += 4) {
    for (std::size_t c = 0; c < 4; ++c) {
      const std::uint16_t* at = sums + 2 * i + c;
      rgba[i + c] = static_cast<std::uint8_t>((at[0] + at[12] + 3 * (at[4] + at[8]) + 32) >> 6);
    }
  }
}

}  // namespace

void AverageSamples(const SampleRows& samples, int first, int rows, Filter filter,
                    std::uint8_t* rgba) {
  const std::size_t row = samples.row;
  std::vector<std::uint16_t> sums(filter == Filter::kSoft ? 4 * (row + 2) : 0);
  const auto at = [&](int k) {
    const int inside = std::clamp(k, samples.from, samples.to) - samples.from;
    return samples.first + row * static_cast<std::size_t>(inside);
  };
  for (int k = rows - 1; k >= 0; --k, rgba += row * 2) {
    const int low = (first + k) * kSamplesAlong;
    if (filter == Filter::kSoft) {
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
