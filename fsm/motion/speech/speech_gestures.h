#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "embedded/gesture_numbers.h"
#include "fsm/motion/inputs/motion_patterns.h"
#include "fsm/motion/speech/viseme_target.h"

namespace fsm {

/// Movements of head, brows and eyes that accompany an utterance, as functions of the position in
/// it (ms): nods on stressed vowels, raised brows on the most stressed, a pose of the head for each
/// phrase, and gaze averted at the beginning and returned before the end. Heads and brows of
/// speakers do move with stress (Hadar et al., Head movement correlates of juncture and stress at
/// sentence level, 1983; Graf et al., Visual prosody, 2002); gestures.txt has the sizes. Stress is
/// estimated from a vowel's length relative to the mean of the utterance, and is greater for open
/// vowels. Everything is at rest before the start and from kHeadReturns after the end.
/// Deterministic for a seed. A value.
class SpeechGestures {
 public:
  /// `sizes`: gestures.txt.
  SpeechGestures(const VisemeTargets& targets, const MovementNumbers& sizes, std::uint64_t seed);

  /// Relative to the greatest angles of the table, about -1..1.
  struct HeadGesture {
    double nod = 0;   ///< down
    double turn = 0;  ///< to the viewer's right
    double tilt = 0;
    double brow = 0;  ///< 0..1
  };
  HeadGesture HeadAt(double position_ms) const;

  /// Returns the averted gaze, down and right, relative to AutoAvert::angle. Zero in utterances
  /// shorter than `shortest_ms`.
  std::array<double, 2> AvertedGazeAt(double position_ms, double shortest_ms) const;
  /// Returns when the eyes jump away and back (ms); {0, 0} in utterances shorter than
  /// `shortest_ms`.
  std::array<double, 2> AversionTimes(double shortest_ms) const;

 private:
  struct Beat {
    double peak_ms;
    double nod;
    double brow;
  };
  struct Phrase {
    double start_ms;
    HeadGesture pose;
  };
  void FindBeats(const VisemeTargets& targets);

  std::uint64_t seed_;
  double length_ms_;
  MovementNumbers sizes_;
  std::vector<Beat> beats_;
  std::vector<Phrase> phrases_;
};

}  // namespace fsm
