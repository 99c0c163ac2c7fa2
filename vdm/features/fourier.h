#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace vdm {

/// The Fourier transform of 512 real samples, by the radix-2 algorithm of Cooley and Tukey (1965)
/// with tables made once: even and odd samples are the real and imaginary parts of 256 complex
/// numbers, whose transform is taken apart afterwards (as in W. H. Press and others, Numerical
/// Recipes, 12.3). Thread: const calls may run at once.
class Fourier512 {
 public:
  static constexpr std::size_t kSize = 512;
  static constexpr std::size_t kBins = kSize / 2 + 1;
  Fourier512();
  /// |X_k|^2 for k = 0 .. 256. REQUIRES: at most kSize samples; the rest counts as zero.
  std::array<float, kBins> Power(std::span<const float> samples) const;

 private:
  static constexpr std::size_t kHalf = kSize / 2;
  /// Real and imaginary parts; 32 bytes suit the widest vectors.
  struct alignas(32) Numbers {
    std::array<float, kHalf> re, im;
  };
  template <int half>
  void Stage(Numbers& x) const;

  Numbers turns_;  // those of a stage of `half` begin at half
  Numbers split_;  // e^(-2 pi i k / 512)
  std::array<std::size_t, kHalf> reversed_;
};

}  // namespace vdm
