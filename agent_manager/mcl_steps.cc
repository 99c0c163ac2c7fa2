// What the steps of a macro do.

#include <utility>

#include "agent_manager/mcl_run.h"
#include "vm_protocol/core/phonemes.h"

namespace am {

using vm::Errc;
using vm::Result;

bool Mcl::Holds(const Run& run, const MacroStep& step) const {
  const auto value = [&](const std::string& name) {
    const auto found = run.variables.find(name);
    return found == run.variables.end() ? std::string() : found->second;
  };
  if (!step.if_present.empty() && !hub_.IsPresent(step.if_present)) return false;
  if (!step.when.empty() && value(step.when).empty()) return false;
  for (const auto& [name, wanted] : step.when_is) {
    if (value(name) != wanted) return false;
  }
  for (const auto& [name, unwanted] : step.unless_is) {
    if (value(name) == unwanted) return false;
  }
  return true;
}

void Mcl::Advance(Run& run) {
  const unsigned long id = run.id;
  while (true) {
    Run* current = Find(id);  // a step may have ended the run
    if (current == nullptr || current->waiting != nullptr || current->asking ||
        current->timer != 0 || !current->branches.empty())
      return;
    if (current->next >= current->list().size()) {
      current->next = 0;
      if (current->phase == Run::Phase::kFinally) return Finish(*current);
      current->phase = Run::Phase::kFinally;
      continue;
    }
    const MacroStep& step = current->list()[current->next++];
    if (Holds(*current, step)) {
      Do(*current, step);
    } else if (!step.otherwise.empty()) {
      StartBranches(*current, {&step.otherwise});
    }
  }
}

bool Mcl::Do(Run& run, const MacroStep& step) {
  using Kind = MacroStep::Kind;
  const auto expanded = [&](const std::string& text) -> std::string {
    auto result = Expand(text, run.variables);
    if (!result) Fail(run, result.error());
    return result.value_or("");
  };
  switch (step.kind) {
    case Kind::kSend:
    case Kind::kRequest:
      return Send(run, step);
    case Kind::kWait:
      return Wait(run, step);
    case Kind::kPause:
      run.timer = clock_.After(step.limit, [this, id = run.id] {
        Run* waiting = Find(id);
        if (waiting == nullptr) return;
        waiting->timer = 0;
        Advance(*waiting);
      });
      return false;
    case Kind::kLet: {
      const std::string value = expanded(step.value);
      run.variables[step.name] = value;
      if (step.keep) kept_[step.name] = value;
      return true;
    }
    case Kind::kStart:
      run.variables[step.name] = vm::FormatMs(clock_.Now() + StartLead(step.of));
      return true;
    case Kind::kFollow:
      run.followers.push_back(&step);
      return true;
    case Kind::kReport:
      if (slots_.Has(step.slot)) slots_.Report(step.slot, expanded(step.value));
      return true;
    case Kind::kMark:
      run.heard.clear();
      return true;
    case Kind::kNeed:
      if (!hub_.IsPresent(step.line))
        Fail(run, {Errc::kUnavailable, step.name + " @" + step.line + " is not there", 0});
      return true;
    case Kind::kBranches: {
      std::vector<const std::vector<MacroStep>*> branches;
      for (const auto& branch : step.branches) branches.push_back(&branch);
      StartBranches(run, branches);
      return false;
    }
    case Kind::kRemove:
      remove_file_(expanded(step.line));
      return true;
  }
  return true;
}

bool Mcl::Send(Run& run, const MacroStep& step) {
  const auto line = Expand(step.line, run.variables);
  if (!line) return Fail(run, line.error()), true;
  const auto message = vm::ParseMessage(*line);
  if (!message) return Fail(run, message.error()), true;
  for (const std::string& name : message->to) run.involved.insert(name);
  if (step.kind == MacroStep::Kind::kSend) {
    hub_.Ask("AM-MCL", *message, [](const Result<std::string>&) {});
    return true;
  }
  const unsigned number = ++run.asked;
  run.asking = number;
  const std::string where = "@" + message->to.front() + " " + message->slot;
  const auto answered = [this, id = run.id, number, where](const Result<std::string>& result) {
    Run* asking = Find(id);
    if (asking == nullptr || asking->asking != number) return;
    asking->asking.reset();
    clock_.Cancel(std::exchange(asking->timer, 0));
    if (!result && asking->phase == Run::Phase::kSteps) {  // stopping goes on regardless
      return Fail(*asking, {result.error().code, where + ": " + result.error().text, 0});
    }
    Advance(*asking);
  };
  run.timer = clock_.After(step.limit, [answered, limit = step.limit] {
    answered(vm::Fail(Errc::kTimeout, "no answer within " + std::to_string(limit.count()) + " ms"));
  });
  hub_.Ask("AM-MCL", *message, answered);
  return false;
}

bool Mcl::Wait(Run& run, const MacroStep& step) {
  if (step.last) {
    const auto last = last_.find({step.from, step.slot});
    if (last != last_.end() && last->second == step.value) return true;
  }
  for (const Heard& heard : run.heard) {
    if (heard.from != step.from || heard.slot != step.slot) continue;
    if (!step.fails_on.empty() && heard.value == step.fails_on) {
      return Fail(run, {Errc::kUnavailable,
                        "@" + step.from + " reports " + step.slot + " = " + heard.value, 0}),
             true;
    }
    if (!step.value.empty() && heard.value != step.value) continue;
    if (!step.into.empty()) run.variables[step.into] = heard.value;
    return true;
  }
  run.waiting = &step;
  vm::Time limit = step.limit;
  if (!step.limit_from.empty()) {
    if (const auto phonemes = vm::ParsePhonemes(run.variables[step.limit_from]))
      limit += vm::TotalDuration(*phonemes);
  }
  run.timer = clock_.After(limit, [this, id = run.id, &step, limit] {
    Run* waiting = Find(id);
    if (waiting == nullptr || waiting->waiting != &step) return;
    waiting->waiting = nullptr;
    waiting->timer = 0;
    if (waiting->phase != Run::Phase::kSteps)
      return Advance(*waiting);  // stopping goes on regardless
    Fail(*waiting, {Errc::kTimeout,
                    "@" + step.from + " did not report " + step.slot +
                        (step.value.empty() ? "" : " = " + step.value) + " within " +
                        vm::FormatMs(limit) + " ms",
                    0});
  });
  return false;
}

}  // namespace am
