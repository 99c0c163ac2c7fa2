#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "embedded/gesture_numbers.h"
#include "fsm/motion/eye_motion.h"
#include "fsm/motion/motion_patterns.h"
#include "fsm/motion/viseme_target.h"

namespace fsm {

/// What head, brows and eyes do with one utterance, as functions of the position in it (ms): nods
/// on the vowels that carry the stress, the brows raised on the strongest, a pose of the head for
/// each phrase, the eyes turned away while the speaker begins and back before the end. Speakers'
/// heads and brows do move with the stress (Hadar et al., Head movement correlates of juncture and
/// stress at sentence level, 1983; Graf et al., Visual prosody, 2002); sizes are the table's.
/// Stress is judged by length: a vowel's against the utterance's mean, more if it is open. All at
/// rest before the start and 700 ms after the end. Seeded; a value.
class SpeechGestures {
 public:
  /// `sizes`: gestures.txt.
  SpeechGestures(const VisemeTargets& visemes, const GestureNumbers& sizes, std::uint64_t seed);

  /// In parts of the table's greatest angles, about -1..1.
  struct At {
    double nod = 0;   ///< down
    double turn = 0;  ///< to the viewer's right
    double tilt = 0;
    double brow = 0;  ///< 0..1
  };
  At HeadAt(double position_ms) const;

  /// In parts of the angle of aversion: down, right. Zero in utterances shorter than `shortest_ms`.
  std::array<double, 2> AvertAt(double position_ms, double shortest_ms) const;
  /// When the eyes jump away and back (ms); {0, 0} in such utterances.
  std::array<double, 2> AvertTimes(double shortest_ms) const;

  static constexpr double kFadeMs = 700;  ///< after the end

 private:
  struct Beat {
    double peak_ms;
    double nod;
    double brow;
  };
  struct Phrase {
    double start_ms;
    At pose;
  };
  void FindBeats(const VisemeTargets& visemes);

  std::uint64_t seed_;
  double length_ms_;
  GestureNumbers sizes_;
  std::vector<Beat> beats_;
  std::vector<Phrase> phrases_;
};

}  // namespace fsm
