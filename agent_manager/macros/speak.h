#pragma once

#include <string_view>

#include "agent_manager/macros/macro.h"

namespace am {

/// Returns the JSON text of the macros every hub has and their slots (built_in.json). The most
/// important one is Speak, which synchronises voice and lips (docs/macros.md).
std::string_view BuiltInMacros();

/// The reader of Speak's value: if `text` starts with `<emotion type="HAPPY" value="80">`, sets
/// `emotion` and `strength` to its attributes and removes the element's tags from `text`.
void ReadEmotion(Variables& variables);

}  // namespace am
