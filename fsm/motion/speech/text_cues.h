#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/expression/face_look.h"
#include "fsm/motion/motion_source.h"

namespace fsm {

struct VisemeTargets;

/// A slight expression that accompanies a sentence; see tables/text_cues.txt.
struct TextLook {
  std::string name;
  bool at_end = false;  ///< shown at the end of the sentence, else throughout
  Angles head{};
  FaceLook units;
};

/// Looks, and the words that cause them. A plain value.
struct TextCues {
  struct Cue {
    std::size_t look = 0;
    std::vector<std::string> phrases;  ///< in lower case
  };
  std::vector<TextLook> looks;
  std::vector<Cue> cues;
};

/// Reads tables/text_cues.txt. Limits: 100 looks, 1000 cues. Error: kBadValue "NAME:LINE: ...".
vm::Result<TextCues> ReadTextCues(const std::string& name, std::string_view text,
                                  const UnitNames& names);

/// A look with its times in an utterance.
struct TimedLook {
  const TextLook* look = nullptr;
  double start_ms = 0, end_ms = 0;

  /// Returns the strength, 0..1, which fades in and out.
  double At(double position_ms) const;
};

/// Returns the looks of a text that is spoken as `visemes`, each at most once per sentence;
/// sentences end at . ! ? and their Japanese forms. The time at which a sentence ends is estimated
/// from the number of letters before it, and moved to the nearest pause of 110 ms or more.
/// Lifetime: `cues` outlives the result.
std::vector<TimedLook> LooksOf(const TextCues& cues, std::string_view text,
                               const VisemeTargets& visemes);

}  // namespace fsm
