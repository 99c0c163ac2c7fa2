#pragma once

#include <cstdint>
#include <span>

#include "srm/align/phone_aligner.h"

namespace srm {

/// Moves the beginnings of pauses to where the sound really ends. The recogniser holds a fading
/// vowel or nasal for speech 40 to 80 ms too long, and takes a soft final f for silence; the level
/// shows it plainly: within 10 ms it falls by more than 20 dB. Where the recording is so noisy that
/// the phoneme before the pause stands out by less than kClear, nothing is moved.
/// Pure; the sum of the phonemes stays.
void PlacePauses(Alignment& alignment, std::span<const std::int16_t> samples);

/// All in dB of the level of 10 ms.
struct PauseEdges {
  static constexpr double kClear = 20;    ///< of the loudest part over the pause's quiet
  static constexpr double kBelow = 20;    ///< the sound ends so far below its loudest part
  static constexpr double kAbove = 6;     ///< but not nearer to the quiet than this
  static constexpr Millis kLongest{160};  ///< a pause's beginning is moved later by at most this
  static constexpr Millis kLeast{20};     ///< of the phoneme and of the pause, stays
};

}  // namespace srm
