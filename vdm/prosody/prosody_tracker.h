#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "vdm/features/fourier.h"
#include "vdm/features/framer.h"
#include "vdm/prosody/pitch_tracker.h"

namespace vdm {

/// What a voice does beside the sounds of its words, at one instant.
struct ProsodyFrame {
  float hz = 0;        ///< fundamental frequency; 0: no voice
  float voicing = 0;   ///< as PitchTracker::Frame
  float power_db = 0;  ///< of 80 to 4000 Hz, over a square of one unit of 16 bit
  float tilt_db = 0;   ///< power from 80 to 1000 Hz over that from 1000 to 4000 Hz
  float vowel_db = 0;  ///< power from 300 to 2500 Hz, where vowels are strong
};

/// Prosody over a stream, each 10 ms: the pitch, and levels of windows of 25 ms (Hann).
/// Sound: 16 kHz mono, in pieces of any size; the frames are the same.
/// Thread: none of its own; one instance, one thread.
class ProsodyTracker {
 public:
  static constexpr std::size_t kHop = PitchTracker::kHop;
  /// Samples after a frame's instant on which it depends.
  static constexpr std::size_t kAhead = PitchTracker::kAhead;

  ProsodyTracker();
  /// Appends the frames that became complete; frame k stands for sample k * kHop.
  void Add(std::span<const std::int16_t> samples, std::vector<ProsodyFrame>& frames);

 private:
  static constexpr std::size_t kWindow = 400;
  static_assert(kWindow / 2 <= kAhead);

  std::array<float, kWindow> window_;
  Fourier512 fourier_;
  Framer framer_{kWindow, kHop};
  PitchTracker pitch_;
  std::deque<ProsodyFrame> levels_{};  // whose pitch is not known yet
  std::vector<PitchTracker::Frame> pitches_{};
};

}  // namespace vdm
