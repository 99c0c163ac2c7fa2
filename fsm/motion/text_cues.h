#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/action_units.h"
#include "fsm/motion/motion_source.h"

namespace fsm {

struct VisemeTargets;

/// A slight look of a sentence; see tables/text_cues.txt.
struct TextLook {
  std::string name;
  bool at_end = false;  ///< of the sentence, else all through it
  Angles head{};
  ActionUnits units;
};

/// Looks, and the words that bring them about. A plain value.
struct TextCues {
  struct Cue {
    std::size_t look = 0;
    std::vector<std::string> phrases;  ///< small letters
  };
  std::vector<TextLook> looks;
  std::vector<Cue> cues;
};

/// At most 100 looks and 1000 cues. kBadValue "NAME:LINE: ...".
vm::Result<TextCues> ReadTextCues(const std::string& name, std::string_view text,
                                  const UnitNames& names);

/// A look of one sentence of an utterance, by its times in the utterance.
struct TimedLook {
  const TextLook* look = nullptr;
  double start_ms = 0, end_ms = 0;

  /// 0 .. 1: it comes and goes softly.
  double At(double position_ms) const;
};

/// The looks of a text that is spoken as `visemes` say, each once a sentence; sentences end at
/// . ! ? and their Japanese forms. Where a sentence ends in time follows from the letters before
/// it, and from the pause of 110 ms or more nearest to there. `cues` outlives them.
std::vector<TimedLook> LooksOf(const TextCues& cues, std::string_view text,
                               const VisemeTargets& visemes);

}  // namespace fsm
