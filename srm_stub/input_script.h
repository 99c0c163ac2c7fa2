#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace srm_stub {

/// One utterance of a script.
struct ScriptLine {
  std::chrono::milliseconds at{0};  ///< from the start of the script
  std::string text{};
  std::size_t number = 0;  ///< its line in the file
};

inline constexpr std::size_t kMaxScriptLines = 10'000;

/// Reads lines `MS TEXT`, in any order of time; blank lines and # comments are skipped. The result
/// is in order of time. Errors with the line's number: kSyntax, kLimit.
vm::Result<std::vector<ScriptLine>> ParseScript(std::string_view text);

}  // namespace srm_stub
