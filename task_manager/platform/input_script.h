#pragma once

#include <functional>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "task_manager/platform/platform.h"
#include "vm_protocol/core/result.h"

namespace vxml {

/// One line of an input script (docs/dialogs.md "Input script").
struct Command {
  enum class Kind { kSay, kDtmf, kSilence, kNoMatch, kTooLong, kHangup, kRecord, kTransfer };
  Kind kind = Kind::kSay;
  std::optional<Millis> at;            ///< since the prompts began; none = after their end
  std::vector<Hypothesis> hypotheses;  ///< kSay, kDtmf (keys)
  Millis duration{0};                  ///< kRecord, kTransfer
  std::string word;                    ///< kTransfer: outcome; kRecord: the key that ends it
  Millis gap{100};                     ///< between keys
  std::size_t line = 0;
};

/// Reads one line. Errors: kEmpty (blank, comment), kSyntax with what was expected.
vm::Result<Command> ParseCommand(std::string_view line);

/// Where commands come from, one at a time; none = no more.
using CommandSource = std::function<std::optional<Command>()>;
/// A whole script. Errors: kSyntax "NAME:LINE: ...", kLimit.
vm::Result<std::vector<Command>> ParseInputScript(std::string_view text, const std::string& name);

}  // namespace vxml
