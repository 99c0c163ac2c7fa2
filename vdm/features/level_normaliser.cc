#include "vdm/features/level_normaliser.h"

#include <algorithm>
#include <cmath>

namespace vdm {
namespace {

/// Where a band of speech is on average in its louder frames, less the peak of the loudness: the
/// long-term spectrum of speech falls by about 6 dB per octave above 500 Hz (Byrne and others, An
/// international comparison of long-term average speech spectra, JASA 96, 1994).
float Usual(std::size_t band) {
  const float x = static_cast<float>(band) / (LevelNormaliser::kBands - 1);
  return 0.2F - 2.6F * x;
}

constexpr float kDeviation = 2.0F;     // of a band's level in speech, about
constexpr float kPeakFalls = 0.0025F;  // a frame: 1.1 dB a second
constexpr float kFloorRises = 0.01F;   // a frame: 4 dB a second
constexpr float kLouder = 4.0F;        // frames within 17 dB of the peak count for the mean

}  // namespace

void LevelNormaliser::Add(const std::array<float, kBands>& bands, std::span<float, kSize> out) {
  float loudness = 0;
  for (const float band : bands) loudness += band;
  loudness /= kBands;
  // The peak rises within some frames, so that one click does not raise it.
  peak_ = loudness > peak_ ? peak_ + 0.3F * (loudness - peak_)
                           : std::max(peak_ - kPeakFalls, kLowestPeak);
  floor_ = loudness < floor_ ? floor_ + 0.3F * (loudness - floor_)
                             : std::min(floor_ + kFloorRises, loudness);
  const float counts = 1 / (1 + std::exp(-2 * (loudness - (peak_ - kLouder))));
  const float keeps = 1 - counts / kMemory;
  weight_ = weight_ * keeps + counts;
  for (std::size_t i = 0; i < kBands; ++i) {
    sums_[i] = sums_[i] * keeps + counts * (bands[i] - peak_);
    const float mean = (sums_[i] + kPrior * Usual(i)) / (weight_ + kPrior);
    out[i] = std::clamp((bands[i] - peak_ - mean) / kDeviation, -6.0F, 3.0F);
  }
  out[kBands] = std::min((loudness - floor_) / 3, 4.0F);
  out[kBands + 1] = std::max((loudness - peak_) / 3, -4.0F);
}

}  // namespace vdm
