#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fsm/motion/speech/dominance_curves.h"
#include "fsm/motion/speech/viseme_target.h"

namespace fsm {

/// The mouth of one utterance as a function of the position in it. It rests until 92 ms before the
/// start and again soon after the end. LipStyle::mode selects the interpolation:
///
/// DOMINANCE: see DominanceCurves.
///
/// SINUSOID: the key viseme of a phoneme is reached at the phoneme's start, and key visemes are
/// interpolated by
///
///     M(t) = W (V0 - V1) + (V0 + V1)/2,  W = cos(pi (t - t0)/(t1 - t0)) / 2
///
/// A phoneme of d >= 200 ms is held for d - 92 ms and then moves; in a shorter one a viseme with a
/// hold (closed lips) is held for that share of it; p, b and m are held for at least about one
/// frame at 30 per second, so that the closure is seen. LINEAR: the same with linear interpolation.
///
/// The mouth closes on phonemes that no table has.
class VisemeTrack {
 public:
  VisemeTrack(const vm::PhonemeList& phonemes, const MotionTables& tables, const LipStyle& style);

  /// Returns the mouth at full articulation, multiplied by the factors of LipStyle.
  MouthPose At(double position_ms) const;
  /// Returns the phoneme at a position; "" outside the utterance.
  const std::string& PhonemeAt(double position_ms) const;
  double length_ms() const { return targets_.length_ms; }
  const VisemeTargets& targets() const { return targets_; }

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
  VisemeTargets targets_;
  std::vector<Span> spans_;
  std::vector<Key> keys_;                  // used by SINUSOID and LINEAR
  std::optional<DominanceCurves> curves_;  // used by DOMINANCE
};

}  // namespace fsm
