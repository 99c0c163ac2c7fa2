#include "agent_manager/mcl.h"

#include <algorithm>
#include <utility>

#include "agent_manager/mcl_run.h"
#include "vm_protocol/core/phonemes.h"

namespace am {

using std::chrono::milliseconds;
using vm::Errc;
using vm::Error;
using vm::Message;
using vm::Reply;
using vm::Result;

namespace {

constexpr vm::Time kStartMargin =
    milliseconds(60);  // room for the mouth to lead, and for a busy machine
constexpr vm::Time kLockstepMargin = milliseconds(60);

/// Takes `<emotion type="HAPPY" value="80">text</emotion>` apart, where a text starts with it.
void TakeEmotion(Variables& variables) {
  const std::string text = variables["text"];
  if (!text.starts_with("<emotion ")) return;
  const std::size_t open_end = text.find('>');
  const std::size_t close = text.find("</emotion>");
  if (open_end == std::string::npos || close == std::string::npos || close < open_end) return;
  const auto attribute = [&](const std::string& name) -> std::string {
    const std::size_t at = text.find(name + "=\"");
    if (at == std::string::npos || at > open_end) return "";
    const std::size_t from = at + name.size() + 2;
    return text.substr(from, text.find('"', from) - from);
  };
  variables["emotion"] = attribute("type");
  variables["strength"] = attribute("value");
  variables["text"] = text.substr(open_end + 1, close - open_end - 1) + text.substr(close + 10);
}

}  // namespace

Mcl::Mcl(vm::Scheduler& clock, Hub& hub, ReadFile read_file, RemoveFile remove_file)
    : clock_(clock),
      hub_(hub),
      read_file_(std::move(read_file)),
      remove_file_(std::move(remove_file)),
      slots_("AM-MCL") {
  DeclareStatusSlots();
  slots_.set_definition_hook([this](const Message& message, vm::PeerId, const Reply& reply) {
    return OnDefinition(message, reply);
  });
}
Mcl::~Mcl() = default;

void Mcl::DeclareStatusSlots() {
  slots_.Declare({.name = "Speak.stat",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = "IDLE",
                  .auto_output = true,
                  .help = "IDLE, PREPARING, READY or SPEAKING."});
  slots_.Declare({.name = "Speak.len",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = "0",
                  .auto_output = true,
                  .help = "How much of the last utterance was spoken, in ms."});
  slots_.Declare({.name = "Speak.utt",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .auto_output = true,
                  .help = "The phonemes of the last utterance that were spoken."});
  slots_.Declare(
      {.name = "AutoEmotionSpeak",
       .grammar = "<int 0..1>",
       .initial = "0",
       .help = "1: the emotion shall also change the voice, where the voice can do it."});
  slots_.Declare({.name = "HeadMoveRatio",
                  .grammar = "<number> <number>",
                  .initial = "1.0 1.0",
                  .help = "Kept for dialogues of the original; the face scales its own movement."});
  slots_.Declare({.name = "Macros",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "The names of all macros.",
                  .on_inq = [this] {
                    std::string names;
                    for (const auto& [name, macro] : macros_)
                      names += (names.empty() ? "" : " ") + name;
                    return names;
                  }});
}

Result<void> Mcl::Define(Macro macro) {
  const std::string name = macro.name;
  if (!vm::IsSlotName(name))
    return vm::Fail(Errc::kBadValue, "'" + name + "' cannot be a macro's name");
  if (RunOf(name) != nullptr) return vm::Fail(Errc::kBusy, "macro '" + name + "' is running");
  if (!macros_.contains(name)) {
    if (slots_.Has(name))
      return vm::Fail(Errc::kAccess, "'" + name + "' is a slot of @AM-MCL and no macro");
    slots_.Declare({.name = name,
                    .grammar = macro.grammar,
                    .access = vm::Access::kWriteOnly,
                    .help = macro.help,
                    .on_set_later = [this, name](const vm::SetValue& value, const Reply& reply) {
                      Start(name, value, reply);
                    }});
  }
  macros_[name] = std::make_shared<const Macro>(std::move(macro));
  for (const std::string& module : hub_.Names()) WatchSlots(module);
  return {};
}

void Mcl::WatchSlots(const std::string& module) {
  std::set<std::string> slots;
  const std::function<void(const std::vector<MacroStep>&)> collect =
      [&](const std::vector<MacroStep>& steps) {
        for (const MacroStep& step : steps) {
          if (step.kind == MacroStep::Kind::kWait && step.from == module) slots.insert(step.slot);
          for (const auto& branch : step.branches) collect(branch);
          collect(step.otherwise);
        }
      };
  for (const auto& [name, macro] : macros_) {
    for (const auto* list : {&macro->steps, &macro->on_stop, &macro->finally}) collect(*list);
  }
  // The original's face reports nothing unasked: whatever a macro waits for is switched on.
  for (const std::string& slot : slots) {
    hub_.Ask(
        "AM-MCL",
        vm::To(module, {{}, "", vm::Command::kProp, "", slot, vm::Relation::kAssign, "AutoOutput"}),
        [](const Result<std::string>&) {});
  }
}

bool Mcl::OnDefinition(const Message& message, const Reply& reply) {
  const auto found = macros_.find(message.slot);
  if (message.command == vm::Command::kDo) {
    if (message.slot.empty() || found == macros_.end()) return false;
    Variables variables{{"value", message.value}, {"text", message.value}};
    Begin(message.slot, std::move(variables), reply);
    return true;
  }
  if (message.command == vm::Command::kDel) {
    if (found == macros_.end()) return false;
    reply.Fail(
        {Errc::kAccess, "macro '" + message.slot + "' can be defined anew but not deleted", 0});
    return true;
  }
  if (message.relation == vm::Relation::kAppend) {  // def NAME << LINE
    const auto line = vm::ParseMessage(message.value);
    if (!line || line->to.empty()) {
      reply.Fail({Errc::kSyntax,
                  "found '" + message.value + "', expected a line with a receiver, to @NAME ...",
                  0});
      return true;
    }
    Macro macro = found == macros_.end() ? Macro{} : *found->second;
    macro.name = message.slot;
    AppendLine(macro, message.value);
    const auto defined = Define(std::move(macro));
    defined ? reply.Ok(message.value) : reply.Fail(defined.error());
    return true;
  }
  std::string text = message.value;
  if (message.relation == vm::Relation::kFromFile) {
    auto read = read_file_(message.value);
    if (!read) {
      reply.Fail(read.error());
      return true;
    }
    text = std::move(*read);
  } else if (!text.starts_with('[') && !text.starts_with('{')) {
    return false;  // a plain user slot
  }
  auto macro = ParseMacro(message.slot, text);
  if (macro) macro->name = message.slot;
  const auto defined =
      macro ? Define(std::move(*macro)) : Result<void>(std::unexpected(macro.error()));
  defined ? reply.Ok("defined") : reply.Fail(defined.error());
  return true;
}

Mcl::Run* Mcl::Find(unsigned long id) {
  const auto found = runs_.find(id);
  return found == runs_.end() ? nullptr : found->second.get();
}
Mcl::Run* Mcl::RunOf(const std::string& macro) {
  for (auto& [id, run] : runs_) {
    if (run->macro->name == macro) return run.get();
  }
  return nullptr;
}

void Mcl::Start(const std::string& name, const vm::SetValue& value, const Reply& reply) {
  const Macro& macro = *macros_.at(name);
  Run* running = RunOf(name);
  if (!macro.stops_on.empty() && value.word(0) == macro.stops_on) {
    if (running == nullptr) {  // modules may have been started past us: stop them all the same
      for (const MacroStep& step : macro.on_stop) {
        if ((step.kind == MacroStep::Kind::kSend || step.kind == MacroStep::Kind::kRequest) &&
            hub_.IsPresent(vm::ParseMessage(step.line)->to.front())) {
          hub_.Ask("AM-MCL", *vm::ParseMessage(step.line), [](const Result<std::string>&) {});
        }
      }
      return reply.Ok(macro.stops_on);
    }
    running->stop_replies.push_back(reply);
    return Stop(*running, "stopped on request");
  }
  Variables variables{{"value", value.text}, {"text", value.text}};
  for (std::size_t i = 0; i < value.size(); ++i) variables[std::to_string(i + 1)] = value.word(i);
  TakeEmotion(variables);
  Begin(name, std::move(variables), reply);
}

void Mcl::Begin(const std::string& name, Variables variables, const Reply& reply) {
  if (Run* running = RunOf(name)) {
    if (running->successor)
      running->successor->second.Fail(
          {Errc::kStopped, "a newer " + name + " took its place before it began", 0});
    running->successor.emplace(std::move(variables), reply);
    return Stop(*running, "a new " + name + " took its place");
  }
  if (macros_.at(name)->status == "Speak.stat") {
    slots_.Store("Speak.len", "0");
    slots_.Store("Speak.utt", "");
  }
  const unsigned long id = ++last_run_;
  for (const auto& [key, value] : kept_) variables.try_emplace(key, value);
  runs_[id].reset(new Run{.id = id,
                          .macro = macros_.at(name),
                          .variables = std::move(variables),
                          .heard = {},
                          .followers = {},
                          .asking = {},
                          .involved = {},
                          .error = {},
                          .reply = reply,
                          .stop_replies = {},
                          .branches = {},
                          .successor = {}});
  Advance(*runs_[id]);
}

vm::Time Mcl::StartLead(const std::vector<std::string>& modules) const {
  if (lockstep_) return kLockstepMargin;
  vm::Time slowest{0};
  for (const std::string& name : modules) slowest = std::max(slowest, hub_.ClockOf(name).delay);
  return slowest + kStartMargin;
}

void Mcl::OnReport(const std::string& from, const Message& message) {
  std::string slot = message.slot;
  std::string value = message.value;
  if (message.command == vm::Command::kTell) {  // "Speak.sync = 1000"
    const std::size_t equals = value.find(" = ");
    if (equals == std::string::npos) return;
    slot = value.substr(0, equals);
    value = value.substr(equals + 3);
  } else {
    last_[{from, slot}] = value;
  }
  std::vector<unsigned long> ids;
  for (const auto& [id, run] : runs_) ids.push_back(id);
  for (const unsigned long id : ids) {
    Run* run = Find(id);
    if (run == nullptr) continue;
    if (run->macro->status == "Speak.stat" && from == "SSM" &&
        (slot == "Speak.len" || slot == "Speak.utt"))
      slots_.Report(slot, value);
    if (run->phase == Run::Phase::kSteps) {
      for (const MacroStep* follower : run->followers) {
        if (follower->from != from || follower->slot != slot) continue;
        Variables variables = run->variables;
        variables["told"] = value;
        if (const auto line = Expand(follower->line, variables)) {
          if (const auto sent = vm::ParseMessage(*line); sent && hub_.IsPresent(sent->to.front()))
            hub_.Ask("AM-MCL", *sent, [](const Result<std::string>&) {});
        }
      }
    }
    if (message.command == vm::Command::kRep) run->heard.push_back({from, slot, value});
    if (run->waiting == nullptr || run->waiting->from != from || run->waiting->slot != slot)
      continue;
    const MacroStep& step = *run->waiting;
    const bool failed = !step.fails_on.empty() && value == step.fails_on;
    if (!failed && !step.value.empty() && value != step.value)
      continue;  // it waits on, its limit unchanged
    run->waiting = nullptr;
    clock_.Cancel(std::exchange(run->timer, 0));
    if (failed) {
      Fail(*run, {Errc::kUnavailable, "@" + from + " reports " + slot + " = " + value, 0});
      continue;
    }
    if (!step.into.empty()) run->variables[step.into] = value;
    Advance(*run);
  }
}

void Mcl::OnPresence(const std::string& name, bool present, const std::string& reason) {
  if (present) return WatchSlots(name);
  std::erase_if(last_, [&](const auto& entry) { return entry.first.first == name; });
  std::vector<unsigned long> ids;
  for (const auto& [id, run] : runs_) ids.push_back(id);
  for (const unsigned long id : ids) {
    Run* run = Find(id);
    if (run == nullptr || !run->involved.contains(name)) continue;
    Fail(*run,
         {Errc::kUnavailable, "@" + name + " has gone in the middle of it (" + reason + ")", 0});
  }
}

void Mcl::Stop(Run& run, const std::string& why) { Fail(run, {Errc::kStopped, why, 0}); }

void Mcl::Fail(Run& run, Error error) {
  if (run.phase != Run::Phase::kSteps) return;  // already ending
  if (run.parent != 0) return FailBranch(run, std::move(error));
  EndBranches(run);
  run.error = std::move(error);
  run.phase = Run::Phase::kStopping;
  run.next = 0;
  run.waiting = nullptr;
  run.asking.reset();
  clock_.Cancel(std::exchange(run.timer, 0));
  // From the loop, not from here: callers may be in the middle of this run.
  run.timer = clock_.Post([this, id = run.id] {
    Run* ending = Find(id);
    if (ending == nullptr) return;
    ending->timer = 0;
    Advance(*ending);
  });
}

void Mcl::Finish(Run& run) {
  if (run.parent != 0) return FinishBranch(run);
  const std::unique_ptr<Run> ended = std::move(runs_.at(run.id));
  runs_.erase(ended->id);
  for (const Reply& reply : ended->stop_replies) reply.Ok(ended->macro->stops_on);
  if (!ended->error) {
    ended->reply.Ok(ended->variables["value"]);
  } else {
    Error error = *ended->error;
    if (error.code == Errc::kStopped && ended->macro->status == "Speak.stat") {
      error.text += " after " + slots_.Value("Speak.len") + " ms: " + slots_.Value("Speak.utt");
    }
    ended->reply.Fail(error);
  }
  if (ended->successor)
    Begin(ended->macro->name, std::move(ended->successor->first), ended->successor->second);
}

}  // namespace am
