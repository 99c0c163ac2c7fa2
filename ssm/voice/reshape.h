#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ssm/voice/pitch_track.h"

namespace ssm {

/// A sound with its pitch, its loudness and where its periods are.
class SoundTrack {
 public:
  explicit SoundTrack(std::span<const std::int16_t> sound);

  std::span<const std::int16_t> sound() const { return sound_; }
  double Hz(double frame) const;  ///< 0 where there is no voice
  double Rms(double frame) const;
  /// The geometric mean of the pitch between two frames; 0 without voice.
  double MeanHz(double begin, double end) const;
  /// The period's place nearest to a frame; the frame itself where nothing has voice.
  double NearestPeriod(double frame) const;
  bool has_voice() const { return !periods_.empty(); }

 private:
  std::span<const std::int16_t> sound_;
  PitchTrack track_;
  std::vector<double> periods_;
};

/// What shall be heard at an instant.
struct SoundWish {
  double from = 0;  ///< the frame of the sound to be heard
  double hz = 0;    ///< its pitch; 0 = as it is
  double gain = 1;
};

/// `frames` frames of sound as wished for: pitch-synchronous overlap and add (E. Moulines, F.
/// Charpentier, Speech Communication 9, 1990). A pitch more than an octave from the sound's own is
/// taken to that, a gain over 8 to 8. `wish` is asked with rising instants, in frames. Pure.
std::vector<std::int16_t> Reshaped(const SoundTrack& track, std::size_t frames,
                                   const std::function<SoundWish(double to)>& wish);

/// The value of a track with one value every PitchTrack::kHop, at a frame; 0 if it is empty.
double ValueAt(const std::vector<double>& track, double frame);

}  // namespace ssm
