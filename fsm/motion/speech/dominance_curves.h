#pragma once

#include <optional>
#include <vector>

#include "embedded/gesture_numbers.h"
#include "fsm/motion/speech/viseme_target.h"

namespace fsm {

/// Computes the mouth of an utterance from overlapping dominance functions (Cohen and Massaro,
/// Modeling coarticulation in synthetic visual speech, 1993): every sound s has a dominance D_s
/// that depends on time and a target T_s, and the value of a parameter is
///
///     F(t) = sum D_s(t) T_s / sum D_s(t)
///
/// The dominance is D = a exp(-3 (d / reach)^2), where d is the distance in time from the sound: it
/// equals the weight a while the sound lasts and falls to 5 % at the distance `reach`. Two equal
/// neighbours therefore contribute equally where they meet, long sounds hold their target, short
/// ones undershoot it, and sounds of little weight (consonants of the tongue) take the lips of
/// their neighbours. Jaw, opening of the lips, rounding and tongue have separate weights; rounding
/// has a separate reach (anticipation).
///
/// Contacts are not undershot: a sound whose shape has one (p b m; f v; w) moves the lips
/// completely to its target, which they reach at its start and keep for its hold time. The approach
/// lies within the sound before. The start of a phoneme is thus the instant at which a closure is
/// complete, and at which any other sound is halfway to its target. In longer pauses the lips meet.
class DominanceCurves {
 public:
  /// `sizes`: gestures.txt.
  DominanceCurves(const VisemeTargets& targets, const DominanceReach& reach,
                  const MovementNumbers& sizes);
  MouthPose At(double position_ms) const;

 private:
  /// The strength of a contact over time: 0 before `rise`, 1 from `from` to `to`, 0 after `fall`.
  struct ContactEnvelope {
    double rise, from, to, fall;
    double At(double position_ms) const;
  };
  struct Sound {
    VisemeTarget target;
    double end_ms;
    std::optional<ContactEnvelope> contact;
  };
  class Blend;
  void PlaceContacts();

  std::vector<Sound> sounds_;  // in order of time; the first and the last are rest and unbounded
  DominanceReach reach_;
  MovementNumbers::Contact contact_;
  double longest_reach_ms_ = 0;
};

}  // namespace fsm
