#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/speakers.h"
#include "vm_protocol/core/result.h"

namespace ssm {

/// What of the original's ssm.conf has a meaning here.
struct OriginalConfig {
  std::vector<SpeakerAlias> speakers;  ///< SPEAKER-ID with its GENDER, in order
  bool auto_play = false;              ///< AUTO-PLAY
  Millis auto_play_delay{0};           ///< AUTO-PLAY-DELAY
  std::string notice;  ///< for people: the keys without a meaning here; empty = none
};

/// Reads `KEY: value` lines, # comments. Keys of the original's engine (models, dictionaries, text
/// analysers, AUDIODEV) are noticed and otherwise ignored.
/// Errors: kSyntax (no colon), kBadValue, kUnknownSlot (a key the original has not either), each
/// with the line's number.
vm::Result<OriginalConfig> ParseOriginalConfig(std::string_view text);

}  // namespace ssm
