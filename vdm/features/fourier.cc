#include "vdm/features/fourier.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace vdm {

Fourier512::Fourier512() {
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    const double angle = -2 * std::numbers::pi * static_cast<double>(i) / kSize;
    turns_[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  for (std::size_t i = 0; i < kSize; ++i) {
    std::size_t reversed = 0;
    for (std::size_t bit = 1, mirror = kSize / 2; bit < kSize; bit <<= 1, mirror >>= 1) {
      if (i & bit) reversed |= mirror;
    }
    reversed_[i] = reversed;
  }
}

std::array<float, Fourier512::kBins> Fourier512::Power(std::span<const float> samples) const {
  assert(samples.size() <= kSize);
  std::array<std::complex<float>, kSize> x{};
  for (std::size_t i = 0; i < samples.size(); ++i) x[reversed_[i]] = samples[i];
  for (std::size_t half = 1; half < kSize; half <<= 1) {
    const std::size_t step = kSize / 2 / half;
    for (std::size_t start = 0; start < kSize; start += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        // Written out: the operator of std::complex looks for infinities.
        const std::complex<float> turn = turns_[k * step], low = x[start + k + half];
        const std::complex<float> turned(low.real() * turn.real() - low.imag() * turn.imag(),
                                         low.real() * turn.imag() + low.imag() * turn.real());
        x[start + k + half] = x[start + k] - turned;
        x[start + k] += turned;
      }
    }
  }
  std::array<float, kBins> power;
  for (std::size_t k = 0; k < kBins; ++k) power[k] = std::norm(x[k]);
  return power;
}

}  // namespace vdm
