#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "agent_manager/access/role.h"
#include "agent_manager/macros/template.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

using Variables = std::map<std::string, std::string>;

struct MacroStep;
using Steps = std::vector<MacroStep>;

// What a step does, one type for each. Their members in JSON: docs/macros.md.
struct SendStep {
  MessageTemplate message;
};
struct RequestStep {
  MessageTemplate message;
  std::chrono::milliseconds limit{5000};
};
struct WaitStep {
  std::string from, slot;
  std::string value;     ///< empty: any
  std::string into;      ///< the variable that gets the value; empty: none
  std::string fails_on;  ///< a value that means failure
  bool last = false;     ///< the slot's last known value counts too
  std::chrono::milliseconds limit{5000};
  std::string limit_from;  ///< a variable with phonemes whose length is added to the limit
};
struct FollowStep {  ///< as long as the steps go on
  std::string from, tell;
  MessageTemplate send;
};
struct MirrorStep {  ///< as long as the run lasts: slots of ours follow a module's of the same name
  std::string from;
  std::vector<std::string> slots;
};
struct ReportStep {
  std::string slot;
  Template value;
};
struct StoreStep {  ///< without a report
  std::map<std::string, std::string> slots;
};
struct PauseStep {
  std::chrono::milliseconds length{0};
};
struct LetStep {
  std::string name;
  Template value;
  bool keep = false;  ///< the variable outlives the run
};
struct StartStep {
  std::string name;             ///< the variable that gets the instant
  std::vector<std::string> of;  ///< the modules that shall start together
};
struct NeedStep {
  std::string module;
  std::string called;  ///< what people call it
};
struct RemoveStep {
  Template file;
};
struct MarkStep {};
struct BranchesStep {  ///< they go on side by side
  std::vector<std::shared_ptr<const Steps>> branches;
};

using Action =
    std::variant<SendStep, RequestStep, WaitStep, FollowStep, MirrorStep, ReportStep, StoreStep,
                 PauseStep, LetStep, StartStep, NeedStep, RemoveStep, MarkStep, BranchesStep>;

/// One step of a macro. A step whose conditions do not hold is passed over.
struct MacroStep {
  Action action;
  std::string if_present;                  ///< a module that must be there
  std::string when;                        ///< a variable that must not be empty
  Variables when_is, unless_is;            ///< variables and their values
  std::shared_ptr<const Steps> otherwise;  ///< instead, where the conditions do not hold
};

/// A macro: what happens in several modules for one `set` or `do`. Does not change once defined.
struct Macro {
  std::string name;
  std::string grammar = "<text>";
  std::string help;
  std::string reads;     ///< how its value is taken apart beside words; empty: not (MacroLayer)
  std::string stops_on;  ///< the value that stops a run instead of starting one
  Template stop_text;    ///< follows the reason in the answer of a run that was stopped
  std::shared_ptr<const Steps> steps, on_stop, finally;
  Role definer = Role::kOwner;  ///< who has defined it
  bool as_definer = false;      ///< it has the definer's rights, whoever starts it
  std::size_t bytes = 0;        ///< of its text
};

/// Macros and the slots beside them, from one JSON text (built_in.json has the form).
struct MacroFile {
  std::vector<vm::SlotSpec> slots;
  std::vector<Macro> macros;
};

/// Reads one macro: an object, or just its list of steps. Its grammar has been checked.
/// Errors: kSyntax, kBadValue; they name the step and the member.
/// Limits: kMaxMacroDepth lists in each other, vm::kMaxMacroLines steps in all.
inline constexpr int kMaxMacroDepth = 16;
vm::Result<Macro> ParseMacro(const std::string& name, std::string_view json_text);
/// Reads macros which carry their names, and slots.
vm::Result<MacroFile> ParseMacroFile(std::string_view json_text);
/// The macro (null: an empty one) with the step "send LINE" at its end (def NAME << LINE).
vm::Result<Macro> WithLine(const Macro* macro, const std::string& name, const std::string& line);

/// Calls `visit` for every step, those within others too.
template <typename Visit>
void ForEachStep(const std::shared_ptr<const Steps>& steps, const Visit& visit) {
  if (steps == nullptr) return;
  for (const MacroStep& step : *steps) {
    visit(step);
    if (const auto* const branching = std::get_if<BranchesStep>(&step.action)) {
      for (const auto& branch : branching->branches) ForEachStep(branch, visit);
    }
    ForEachStep(step.otherwise, visit);
  }
}

}  // namespace am
