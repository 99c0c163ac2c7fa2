#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>

namespace vdm {

/// The Fourier transform of 512 real samples, by the radix-2 algorithm of Cooley and Tukey (1965)
/// with tables made once. Thread: const calls may run at once.
class Fourier512 {
 public:
  static constexpr std::size_t kSize = 512;
  static constexpr std::size_t kBins = kSize / 2 + 1;
  Fourier512();
  /// |X_k|^2 for k = 0 .. 256. REQUIRES: at most kSize samples; the rest counts as zero.
  std::array<float, kBins> Power(std::span<const float> samples) const;

 private:
  std::array<std::complex<float>, kSize / 2> turns_;
  std::array<std::size_t, kSize> reversed_;
};

}  // namespace vdm
