#pragma once

#include <string_view>
#include <vector>

#include "embedded/gesture_numbers.h"
#include "fsm/motion/inputs/text_cues.h"

namespace fsm {

struct VisemeTargets;

/// A look with its times in an utterance.
struct TimedLook {
  const TextLook* shown = nullptr;
  double start_ms = 0, end_ms = 0;

  /// Returns the strength, 0..1, which fades in and out.
  double At(double position_ms, const MovementNumbers& sizes) const;
};

/// Returns the looks of a text that is spoken as `targets`, each at most once per sentence;
/// sentences end at . ! ? and their Japanese forms. The time at which a sentence ends is estimated
/// from the number of letters before it, and moved to the nearest pause of 110 ms or more.
/// `sizes`: gestures.txt. Lifetime: `cues` outlives the result.
std::vector<TimedLook> LooksOf(const TextCues& cues, std::string_view text,
                               const VisemeTargets& targets, const MovementNumbers& sizes);

}  // namespace fsm
