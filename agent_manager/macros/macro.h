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

// What a step does, one type for each action. Their members in JSON: docs/macros.md.
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
struct FollowStep {  ///< until its sequence ends: sends a message for each `tell` of a module
  std::string from, tell;
  MessageTemplate send;
};
struct MirrorStep {  ///< until the run ends: our slots copy a module's slots of the same name
  std::string from;
  std::vector<std::string> slots;
};
struct ReportStep {
  std::string slot;
  Template value;
};
struct StoreStep {  ///< sets slots without reporting them
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
  std::string called;  ///< how error messages name it
};
struct RemoveStep {
  Template file;
};
struct MarkStep {};
struct BranchesStep {  ///< runs lists of steps at the same time
  std::vector<std::shared_ptr<const Steps>> branches;
};

using Action =
    std::variant<SendStep, RequestStep, WaitStep, FollowStep, MirrorStep, ReportStep, StoreStep,
                 PauseStep, LetStep, StartStep, NeedStep, RemoveStep, MarkStep, BranchesStep>;

/// One step of a macro. A step whose conditions do not hold is skipped.
struct MacroStep {
  Action action;
  std::string if_present{};                  ///< a module that must be present
  std::string if_modern{};                   ///< one that must be there and know tags
  std::string when{};                        ///< a variable that must not be empty
  Variables when_is{}, unless_is{};          ///< variables and their values
  std::shared_ptr<const Steps> otherwise{};  ///< run if the conditions do not hold
};

/// A macro: the steps that one `set` or `do` starts in several modules. Immutable once defined.
struct Macro {
  std::string name;
  std::string grammar = "<text>";
  std::string help;
  std::string reads;  ///< a reader of MacroLayer that sets more variables from the value; or empty
  std::string stops_on;  ///< the value that stops a run instead of starting one
  Template stop_text;    ///< added to the reason when a stopped run is answered
  std::shared_ptr<const Steps> steps, on_stop, finally;
  Role definer = Role::kOwner;  ///< the role of the peer that defined it
  bool as_definer = false;      ///< it runs with the definer's rights, not its caller's
  std::size_t bytes = 0;        ///< length of its text
};

/// Macros and the slots of @AM-MCL that they use, from one JSON text such as built_in.json.
struct MacroFile {
  std::vector<vm::SlotSpec> slots;
  std::vector<Macro> macros;
};

/// Reads one macro: an object, or only its list of steps.
/// Errors: kSyntax for what is not JSON; kBadValue, naming the step and the member, also for a
/// grammar that cannot be parsed.
/// Limits: kMaxMacroDepth nested lists, vm::kMaxMacroLines steps in all.
inline constexpr int kMaxMacroDepth = 16;
vm::Result<Macro> ParseMacro(const std::string& name, std::string_view json_text);
/// Reads slots and macros; each macro has a member `name`. Errors and limits: as ParseMacro.
vm::Result<MacroFile> ParseMacroFile(std::string_view json_text);
/// Returns a copy of the macro (null: of an empty one) with the step "send LINE" at its end, as
/// `def NAME << LINE` asks. Errors: as MessageTemplate::Parse; kLimit.
vm::Result<Macro> WithLine(const Macro* macro, const std::string& name, const std::string& line);

/// Calls `visit` for every step, including those in branches and in `else`.
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
