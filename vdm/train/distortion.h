#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vdm/train/dice.h"

namespace vdm {

/// Speech as it might have come from somebody else and elsewhere.
struct HeardSpeech {
  std::vector<std::int16_t> samples;
  double start_ms = 0;  ///< where in it the speech begins
  double speed = 1;     ///< how many ms of the speech pass in one of it
  float warp = 1;       ///< by which its features are to be read (MakeFeatures)
};

/// By chance: another speed and pitch, another vocal tract, a room (an impulse response of sparse
/// noise that fades), noise or music behind it, a telephone's or another limited band, a
/// microphone's tilt, another level, clipping; with background before and after.
HeardSpeech Distorted(std::span<const std::int16_t> speech, Dice dice);

/// Noise, music or silence alone, of four seconds.
std::vector<std::int16_t> NoSpeech(Dice dice);

}  // namespace vdm
