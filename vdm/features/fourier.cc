#include "vdm/features/fourier.h"

#include <Eigen/Core>
#include <cassert>
#include <cmath>
#include <numbers>

namespace vdm {

Fourier512::Fourier512() {
  const auto turn = [](Numbers& table, std::size_t at, double angle) {
    table.re[at] = static_cast<float>(std::cos(angle));
    table.im[at] = static_cast<float>(std::sin(angle));
  };
  constexpr double kTurn = -2 * std::numbers::pi;
  turn(turns_, 0, 0);
  for (std::size_t half = 1; half < kHalf; half *= 2) {
    for (std::size_t k = 0; k < half; ++k) {
      turn(turns_, half + k, kTurn * static_cast<double>(k) / static_cast<double>(2 * half));
    }
  }
  for (std::size_t i = 0; i < kHalf; ++i) {
    turn(split_, i, kTurn * static_cast<double>(i) / kSize);
    std::size_t reversed = 0;
    for (std::size_t bit = 1, mirror = kHalf / 2; bit < kHalf; bit <<= 1, mirror >>= 1) {
      if (i & bit) reversed |= mirror;
    }
    reversed_[i] = reversed;
  }
}

/// Joins transforms of `half` numbers into those of twice as many, several at once.
template <int half>
void Fourier512::Stage(Numbers& x) const {
  using Part = Eigen::Array<float, half, 1>;
  const Eigen::Map<const Part> turn_re(&turns_.re[half]), turn_im(&turns_.im[half]);
  for (std::size_t start = 0; start < kHalf; start += 2 * half) {
    Eigen::Map<Part> low_re(&x.re[start]), low_im(&x.im[start]);
    Eigen::Map<Part> high_re(&x.re[start + half]), high_im(&x.im[start + half]);
    const Part re = high_re * turn_re - high_im * turn_im;
    const Part im = high_re * turn_im + high_im * turn_re;
    high_re = low_re - re;
    high_im = low_im - im;
    low_re += re;
    low_im += im;
  }
}

std::array<float, Fourier512::kBins> Fourier512::Power(std::span<const float> samples) const {
  assert(samples.size() <= kSize);
  Numbers x{};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    (i % 2 == 0 ? x.re : x.im)[reversed_[i / 2]] = samples[i];
  }
  Stage<1>(x);
  Stage<2>(x);
  Stage<4>(x);
  Stage<8>(x);
  Stage<16>(x);
  Stage<32>(x);
  Stage<64>(x);
  Stage<128>(x);
  std::array<float, kBins> power;
  for (std::size_t k = 0; k < kHalf; ++k) {
    // The transforms of the even samples (a) and of the odd ones (b), then a + turn b.
    const std::size_t mirror = (kHalf - k) % kHalf;
    const float a_re = 0.5F * (x.re[k] + x.re[mirror]), a_im = 0.5F * (x.im[k] - x.im[mirror]);
    const float b_re = 0.5F * (x.im[k] + x.im[mirror]), b_im = 0.5F * (x.re[mirror] - x.re[k]);
    const float re = a_re + split_.re[k] * b_re - split_.im[k] * b_im;
    const float im = a_im + split_.re[k] * b_im + split_.im[k] * b_re;
    power[k] = re * re + im * im;
  }
  const float last = x.re[0] - x.im[0];
  power[kHalf] = last * last;
  return power;
}

}  // namespace vdm
