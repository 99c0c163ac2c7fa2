#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vdm/net/mouth_frame.h"

namespace vdm {

/// What the words of a recording have the mouth do, known before it is played: that of a text where
/// the words are likely, so that a network that hears little ahead is asked less.
struct RecordedMouth {
  static constexpr std::size_t kHopSamples = 160;
  struct Instant {
    MouthFrame frame{};  ///< without sounds
    float trust = 0;     ///< its share, 0 .. 1; the rest is the network's
  };
  std::vector<Instant> instants{};  ///< kHopSamples apart from the first sample on
  std::string text{};               ///< the words that were recognised

  /// What a network says of the mouth at a sample, and the words.
  void Blend(std::uint64_t sample, MouthFrame& frame) const;
};

}  // namespace vdm
