#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ssm/voice/samples.h"

namespace ssm {

/// Pitch and loudness of sound, one value every kHop, the first one at instant 0.
struct PitchTrack {
  static constexpr std::chrono::milliseconds kHop{5};
  static constexpr double kLowestHz = 60, kHighestHz = 500;
  std::vector<double> hz;   ///< 0 where there is no voice
  std::vector<double> rms;  ///< of 10 ms, in units of a sample
};

/// By autocorrelation over 32 ms, normalised; a frame has voice if it is over 0.5 and not 35 dB
/// below the loudest. Pure; 25 million multiplications for a second of sound.
PitchTrack MeasurePitch(std::span<const std::int16_t> samples);

}  // namespace ssm
