#pragma once

#include <string>
#include <vector>

#include "fsm/motion/motion_tables.h"
#include "vm_protocol/core/phonemes.h"

namespace fsm {

enum class Language {
  kAuto,  ///< English if the list has an English vowel in it, else Japanese
  kJapanese,
  kEnglish,
};

/// The mouth of one utterance as a function of the position in it. The key shape of a phoneme
/// stands at the phoneme's start, and key shapes are joined by sinusoids:
///
///     M(t) = W (V0 - V1) + (V0 + V1)/2,  W = cos(pi (t - t0)/(t1 - t0)) / 2
///
/// A phoneme of 200 ms or more is split into (d - 92) + 92, so it holds and then moves; a shape
/// with a hold (closed lips) stands for that share of a shorter one; p, b and m at least for about
/// one frame at 30 a second, so that the closure is seen. Phonemes the table does not know close
/// the mouth.
class LipTrack {
 public:
  LipTrack(const vm::PhonemeList& phonemes, const MotionTables& tables, Language language);

  /// Full articulation; rest before the start (with an approach of 92 ms) and after the end.
  MouthPose At(double position_ms) const;
  /// The phoneme sounding at a position; "" outside the utterance.
  const std::string& PhonemeAt(double position_ms) const;
  double length_ms() const { return length_ms_; }
  bool english() const { return english_; }

  static constexpr double kApproachMs = 92;  ///< the original's time of transition

 private:
  struct Key {
    double ms;
    MouthPose pose;
  };
  struct Span {
    double start_ms;
    std::string name;
  };
  std::vector<Key> keys_;
  std::vector<Span> spans_;
  double length_ms_ = 0;
  bool english_ = false;
};

}  // namespace fsm
