#pragma once

#include <array>
#include <span>

namespace vdm {

/// Takes out of log band energies what belongs to the speaker's loudness, the microphone and the
/// room: each band's mean over the louder frames, on the fly. The mean starts from the mean of
/// speech (relative to its peak) and moves to the sound's own with about kMemory frames of memory,
/// so the first syllable is treated much as the hundredth.
/// Levels are natural logarithms of power at 16 bit full scale.
class LevelNormaliser {
 public:
  static constexpr std::size_t kBands = 24;
  static constexpr std::size_t kSize = kBands + 2;

  /// `bands` becomes: the bands less their means, in units of about their deviation; the loudness
  /// above the noise; the loudness below the peak.
  void Add(const std::array<float, kBands>& bands, std::span<float, kSize> out);

 private:
  std::array<float, kBands> sums_{};  // weighted, of bands less the peak at their time
  float weight_ = 0;
  float peak_ = kLowestPeak;
  float floor_ = kLowestPeak;

  // Speech much below this loudness is not followed: -60 dB of full scale.
  static constexpr float kLowestPeak = 9.5F;
  static constexpr float kMemory = 500;
  static constexpr float kPrior = 40;
};

}  // namespace vdm
