#pragma once

#include <string_view>

#include "agent_manager/macros/macro.h"

namespace am {

/// The macros that are always there (built_in.json), above all Speak, which keeps voice and lips in
/// step (docs/macros.md), with the slots beside them.
std::string_view BuiltInMacros();

/// How Speak reads its value: takes `<emotion type="HAPPY" value="80">text</emotion>` apart where a
/// text starts with it, into `emotion`, `strength` and `text`.
void ReadEmotion(Variables& variables);

}  // namespace am
