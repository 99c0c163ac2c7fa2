#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace am {

/// One step of a macro. What the members mean in JSON: docs/macros.md.
struct MacroStep {
  enum class Kind {
    kSend,
    kRequest,
    kWait,
    kPause,
    kLet,
    kStart,
    kFollow,
    kReport,
    kMark,
    kNeed,
    kRemove,
    kBranches
  };
  Kind kind = Kind::kSend;
  std::string line;  ///< kSend, kRequest: the message; kRemove: the file; kNeed: the module
  std::string from, slot, value,
      into;                     ///< kWait; kReport uses slot and value; kFollow from and slot
  std::string fails_on;         ///< kWait: a value that means failure
  bool last = false;            ///< kWait: the slot's last known value counts too
  std::string name;             ///< kLet, kStart: the variable; kNeed: what people call the module
  std::vector<std::string> of;  ///< kStart: the modules that shall start together
  std::chrono::milliseconds limit{5000};  ///< kRequest, kWait, kPause (the length)
  std::string limit_from;  ///< kWait: a variable with phonemes whose length is added to the limit
  bool keep = false;       ///< kLet: the variable outlives the run

  std::vector<std::vector<MacroStep>> branches;  ///< kBranches: they go on side by side
  std::vector<MacroStep> otherwise;              ///< instead, where the conditions do not hold

  // Conditions; a step whose conditions do not hold is passed over.
  std::string if_present;  ///< a module that must be there
  std::string when;        ///< a variable that must not be empty
  std::map<std::string, std::string> when_is, unless_is;
};

/// A macro: what happens in several modules for one `set` or `do`.
struct Macro {
  std::string name;
  std::string grammar = "<text>";
  std::string help;
  std::string status;    ///< a slot kept at IDLE while it does not run; empty = none
  std::string stops_on;  ///< the value that stops a run instead of starting one
  std::vector<MacroStep> steps, on_stop, finally;
};

/// Reads one macro: an object, or just its list of steps. Errors name the step and the member.
vm::Result<Macro> ParseMacro(const std::string& name, std::string_view json_text);
/// Reads a list of macros which carry their names.
vm::Result<std::vector<Macro>> ParseMacros(std::string_view json_text);
/// Adds the step "send LINE" to a macro (def NAME << LINE).
void AppendLine(Macro& macro, const std::string& line);

using Variables = std::map<std::string, std::string>;
/// Puts variables into a text: ${name}, ${name:-default}, and ${name|plain}, which writes a phoneme
/// list in the form of LipSync.pho. Errors: kBadValue for an unknown filter, an open brace, or
/// phonemes that cannot be read.
vm::Result<std::string> Expand(std::string_view text, const Variables& variables);

}  // namespace am
