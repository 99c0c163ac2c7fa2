#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fsm/motion/dominance_curves.h"
#include "fsm/motion/viseme_target.h"

namespace fsm {

/// The mouth of one utterance as a function of the position in it; rest before the start (with an
/// approach of 92 ms) and soon after the end. By mode:
///
/// DOMINANCE: see DominanceCurves.
///
/// SINUSOID: the key viseme of a phoneme stands at the phoneme's start, and key visemes are joined
/// by
///
///     M(t) = W (V0 - V1) + (V0 + V1)/2,  W = cos(pi (t - t0)/(t1 - t0)) / 2
///
/// A phoneme of 200 ms or more is split into (d - 92) + 92, so it holds and then moves; a viseme
/// with a hold (closed lips) stands for that share of a shorter one; p, b and m at least for about
/// one frame at 30 a second, so that the closure is seen. LINEAR: the same with straight lines.
///
/// Phonemes no table knows close the mouth.
class VisemeTrack {
 public:
  VisemeTrack(const vm::PhonemeList& phonemes, const MotionTables& tables, const LipStyle& style);

  /// Full articulation, times the style's scales.
  MouthPose At(double position_ms) const;
  /// The phoneme sounding at a position; "" outside the utterance.
  const std::string& PhonemeAt(double position_ms) const;
  double length_ms() const { return visemes_.length_ms; }
  const VisemeTargets& visemes() const { return visemes_; }

 private:
  struct Key {
    double ms;
    MouthPose pose;
  };
  struct Span {
    double start_ms;
    std::string name;
  };
  void MakeKeys();

  LipMode mode_;
  VisemeTargets visemes_;
  std::vector<Span> spans_;
  std::vector<Key> keys_;                  // of the modes with key visemes
  std::optional<DominanceCurves> curves_;  // of the other
};

}  // namespace fsm
