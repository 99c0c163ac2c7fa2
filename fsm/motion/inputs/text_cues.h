#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/base/face_look.h"

namespace fsm {

/// A slight expression that accompanies a sentence; see tables/text_cues.txt.
struct TextLook {
  std::string name;
  bool at_end = false;  ///< shown at the end of the sentence, else throughout
  Angles head_rotation{};
  FaceLook look;
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

}  // namespace fsm
