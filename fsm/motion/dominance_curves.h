#pragma once

#include <optional>
#include <vector>

#include "fsm/motion/viseme_target.h"

namespace fsm {

/// The mouth of an utterance by overlapping dominance (Cohen and Massaro, Modeling coarticulation
/// in synthetic visual speech, 1993): every sound s has a bell of dominance D_s over time and a
/// target T_s, and a parameter is at
///
///     F(t) = sum D_s(t) T_s / sum D_s(t)
///
/// A bell stands at its weight for the sound's own time and falls to 5 % within its reach outside,
/// D = a exp(-3 (d / reach)^2) with d the distance from the sound's time; so two equal neighbours
/// have equal say where they meet, long sounds hold, short ones are undershot, and weak ones
/// (consonants of the tongue) take the lips of their neighbours. Jaw, opening of the lips, rounding
/// and tongue each have weights of their own, and rounding a reach of its own (anticipation).
///
/// Contacts are not undershot: a sound whose shape has one (p b m; f v; w) takes the lips wholly to
/// its target, from its start for its hold, the approach being at most 55 ms and within the sound
/// before. So the key instant of a closure is the start of its phoneme; of every other sound it is
/// the passing of the halfway point at its start. In pauses of 120 ms and more the lips meet.
class DominanceCurves {
 public:
  DominanceCurves(const VisemeTargets& visemes, const Reach& reach);
  MouthPose At(double position_ms) const;

 private:
  /// When a contact is made: 0 before `rise`, 1 from `from` to `to`, 0 after `fall`.
  struct Contact {
    double rise, from, to, fall;
    double At(double position_ms) const;
  };
  struct Sound {
    VisemeTarget viseme;
    double end_ms;
    std::optional<Contact> contact;
  };
  class Blend;
  void PlaceContacts();

  std::vector<Sound> sounds_;  // in time; the first and the last are rest without end
  Reach reach_;
  double longest_reach_ms_ = 0;
};

}  // namespace fsm
