// Reads macros from JSON: a table of the actions, and readers for every other member of a step.

#include <algorithm>
#include <functional>
#include <set>

#include "agent_manager/config/config_json.h"
#include "agent_manager/macros/macro.h"
#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/value_grammar.h"

namespace am {
namespace {

using std::chrono::milliseconds;
using vm::Errc;
using vm::Fail;
using vm::Result;

constexpr long kLongestMs = 3'600'000;

/// What has been read of one macro; counted against its limits.
struct Budget {
  std::size_t steps = 0;
};

template <typename T>
T Need(Result<T> result, const std::string& key) {
  if (!result) throw ConfigFault{key, result.error().text};
  return std::move(*result);
}

Template TemplateOf(const json& value, const std::string& key) {
  return Need(Template::Parse(Text(value, key)), key);
}

MessageTemplate MessageOf(const json& value, const std::string& key) {
  return Need(MessageTemplate::Parse(Text(value, key)), key);
}

Variables TextsByName(const json& value, const std::string& key) {
  if (!value.is_object()) Wrong(key, value, "an object of strings");
  Variables texts;
  for (const auto& [name, member] : value.items()) texts[name] = Text(member, key + "." + name);
  return texts;
}

/// A reader that stores a string in `target`.
Readers::mapped_type Into(std::string& target) {
  return [&target](const json& v, const std::string& k) { target = Text(v, k); };
}

std::shared_ptr<const Steps> ReadSteps(const json& list, const std::string& key, int depth,
                                       Budget& budget);

WaitStep ReadWait(const json& value, const std::string& key) {
  WaitStep wait;
  ReadObject(value, key,
             {{"from", Into(wait.from)},
              {"slot", Into(wait.slot)},
              {"value", Into(wait.value)},
              {"into", Into(wait.into)},
              {"fails_on", Into(wait.fails_on)},
              {"last", [&](const json& v, const std::string& k) { wait.last = Flag(v, k); }}});
  if (wait.from.empty() || wait.slot.empty()) throw ConfigFault{key, "expected from and slot"};
  return wait;
}

FollowStep ReadFollow(const json& value, const std::string& key) {
  FollowStep follow;
  bool sends = false;
  ReadObject(value, key,
             {{"from", Into(follow.from)},
              {"tell", Into(follow.tell)},
              {"send", [&](const json& v, const std::string& k) {
                 follow.send = MessageOf(v, k);
                 sends = true;
               }}});
  if (follow.from.empty() || follow.tell.empty() || !sends)
    throw ConfigFault{key, "expected from, tell and send"};
  return follow;
}

MirrorStep ReadMirror(const json& value, const std::string& key) {
  MirrorStep mirror;
  ReadObject(value, key,
             {{"from", Into(mirror.from)},
              {"slots", [&](const json& v, const std::string& k) { mirror.slots = Texts(v, k); }}});
  if (mirror.from.empty() || mirror.slots.empty())
    throw ConfigFault{key, "expected from and slots"};
  return mirror;
}

ReportStep ReadReport(const json& value, const std::string& key) {
  ReportStep report;
  bool has_value = false;
  ReadObject(value, key,
             {{"slot", Into(report.slot)}, {"value", [&](const json& v, const std::string& k) {
                                              report.value = TemplateOf(v, k);
                                              has_value = true;
                                            }}});
  if (report.slot.empty() || !has_value) throw ConfigFault{key, "expected slot and value"};
  return report;
}

LetStep ReadLet(const json& value, const std::string& key) {
  if (!value.is_object() || value.size() != 1) Wrong(key, value, "an object with one variable");
  return {value.begin().key(), TemplateOf(value.begin().value(), key), false};
}

BranchesStep ReadParallel(const json& value, const std::string& key, int depth, Budget& budget) {
  BranchesStep step;
  ReadList(value, key, "a list of lists of steps", [&](const json& list, const std::string& at) {
    step.branches.push_back(ReadSteps(list, at, depth + 1, budget));
  });
  if (step.branches.empty()) Wrong(key, value, "a list of lists of steps");
  return step;
}

/// The members that say what a step does; each step has one of them.
using ReadAction =
    std::function<Action(const json& value, const std::string& key, int depth, Budget& budget)>;
const std::map<std::string, ReadAction>& Actions() {
  using S = const std::string&;
  static const std::map<std::string, ReadAction> actions{
      {"send", [](const json& v, S k, int, Budget&) { return SendStep{MessageOf(v, k)}; }},
      {"request", [](const json& v, S k, int, Budget&) { return RequestStep{MessageOf(v, k)}; }},
      {"wait", [](const json& v, S k, int, Budget&) { return ReadWait(v, k); }},
      {"follow", [](const json& v, S k, int, Budget&) { return ReadFollow(v, k); }},
      {"mirror", [](const json& v, S k, int, Budget&) { return ReadMirror(v, k); }},
      {"report", [](const json& v, S k, int, Budget&) { return ReadReport(v, k); }},
      {"store", [](const json& v, S k, int, Budget&) { return StoreStep{TextsByName(v, k)}; }},
      {"pause_ms",
       [](const json& v, S k, int, Budget&) { return PauseStep{Millis(v, k, 0, kLongestMs)}; }},
      {"let", [](const json& v, S k, int, Budget&) { return ReadLet(v, k); }},
      {"start",
       [](const json& v, S k, int, Budget&) {
         return StartStep{Text(v, k), {}};
       }},
      {"need",
       [](const json& v, S k, int, Budget&) {
         return NeedStep{Text(v, k), {}};
       }},
      {"remove", [](const json& v, S k, int, Budget&) { return RemoveStep{TemplateOf(v, k)}; }},
      {"mark", [](const json&, S, int, Budget&) { return MarkStep{}; }},
      {"parallel", [](const json& v, S k, int depth,
                      Budget& budget) { return ReadParallel(v, k, depth, budget); }},
      {"steps", [](const json& v, S k, int depth, Budget& budget) {
         return BranchesStep{{ReadSteps(v, k, depth + 1, budget)}};
       }}};
  return actions;
}

[[noreturn]] void NoSuchMember(const std::string& key) {
  throw ConfigFault{key, "this kind of step has no such member"};
}

/// A reader of a member that only steps of the kind `Step` have.
template <typename Step, typename Set>
Readers::mapped_type Of(MacroStep& step, Set set) {
  return [&step, set](const json& v, const std::string& k) {
    auto* const of = std::get_if<Step>(&step.action);
    if (of == nullptr) NoSuchMember(k);
    set(*of, v, k);
  };
}

/// Reads the one member that says what the step does. Returns whether there is one.
bool ReadActionOf(MacroStep& step, const json& object, const std::string& key, int depth,
                  Budget& budget) {
  std::string chosen;
  for (const auto& [name, value] : object.items()) {
    const auto action = Actions().find(name);
    if (action == Actions().end()) continue;
    if (!chosen.empty()) throw ConfigFault{key, "expected either " + chosen + " or " + name};
    chosen = name;
    step.action = action->second(value, key + "." + name, depth, budget);
  }
  return !chosen.empty();
}

void SetLimit(MacroStep& step, const json& value, const std::string& key) {
  const milliseconds limit = Millis(value, key, 0, kLongestMs);
  if (auto* const request = std::get_if<RequestStep>(&step.action)) {
    request->limit = limit;
  } else if (auto* const wait = std::get_if<WaitStep>(&step.action)) {
    wait->limit = limit;
  } else {
    NoSuchMember(key);
  }
}

/// Readers of every member a step may have; those of the action, which has been read, do nothing.
Readers StepReaders(MacroStep& step, int depth, Budget& budget) {
  using S = const std::string&;
  Readers readers{
      {"of", Of<StartStep>(step, [](StartStep& s, const json& v, S k) { s.of = Texts(v, k); })},
      {"text", Of<NeedStep>(step, [](NeedStep& s, const json& v, S k) { s.called = Text(v, k); })},
      {"keep", Of<LetStep>(step, [](LetStep& s, const json& v, S k) { s.keep = Flag(v, k); })},
      {"limit_from",
       Of<WaitStep>(step, [](WaitStep& s, const json& v, S k) { s.limit_from = Text(v, k); })},
      {"limit_ms", [&step](const json& v, S k) { SetLimit(step, v, k); }},
      {"if_present", Into(step.if_present)},
      {"if_modern", Into(step.if_modern)},
      {"when", Into(step.when)},
      {"when_is", [&step](const json& v, S k) { step.when_is = TextsByName(v, k); }},
      {"unless_is", [&step](const json& v, S k) { step.unless_is = TextsByName(v, k); }},
      {"else", [&step, depth, &budget](const json& v, S k) {
         step.otherwise = ReadSteps(v, k, depth + 1, budget);
       }}};
  for (const auto& [name, action] : Actions())
    readers.emplace(name, [](const json&, const std::string&) {});
  return readers;
}

MacroStep ReadStep(const json& object, const std::string& key, int depth, Budget& budget) {
  if (!object.is_object()) Wrong(key, object, "an object");
  if (++budget.steps > vm::kMaxMacroLines)
    throw ConfigFault{key, "more than " + std::to_string(vm::kMaxMacroLines) + " steps"};
  MacroStep step;
  const bool acts = ReadActionOf(step, object, key, depth, budget);
  const Readers readers = StepReaders(step, depth, budget);
  bool all_known = true;  // else ReadObject names the member that is not
  for (const auto& [name, value] : object.items()) all_known = all_known && readers.contains(name);
  if (!acts && all_known) {
    std::string kinds;
    for (const auto& [name, action] : Actions()) kinds += (kinds.empty() ? "" : ", ") + name;
    throw ConfigFault{key, "expected exactly one of " + kinds};
  }
  ReadObject(object, key, readers);
  return step;
}

std::shared_ptr<const Steps> ReadSteps(const json& list, const std::string& key, int depth,
                                       Budget& budget) {
  if (depth > kMaxMacroDepth)
    throw ConfigFault{key, "more than " + std::to_string(kMaxMacroDepth) + " lists in each other"};
  auto steps = std::make_shared<Steps>();
  ReadList(list, key, "a list of steps", [&](const json& step, const std::string& at) {
    steps->push_back(ReadStep(step, at, depth, budget));
  });
  return steps;
}

Macro ReadMacro(const std::string& name, const json& object) {
  Macro macro;
  macro.name = name;
  Budget budget;
  const std::string key = name.empty() ? "macro" : name;
  const auto steps = [&](std::shared_ptr<const Steps>& target) -> Readers::mapped_type {
    return [&](const json& v, const std::string& k) { target = ReadSteps(v, k, 0, budget); };
  };
  if (object.is_array()) {
    steps(macro.steps)(object, key);
    return macro;
  }
  ReadObject(object, key,
             {{"name", Into(macro.name)},
              {"grammar", Into(macro.grammar)},
              {"help", Into(macro.help)},
              {"reads", Into(macro.reads)},
              {"stops_on", Into(macro.stops_on)},
              {"stop_text",
               [&](const json& v, const std::string& k) { macro.stop_text = TemplateOf(v, k); }},
              {"rights",
               [&](const json& v, const std::string& k) {
                 macro.as_definer = OneOf<bool>(v, k, {{"definer", true}, {"caller", false}});
               }},
              {"steps", steps(macro.steps)},
              {"on_stop", steps(macro.on_stop)},
              {"finally", steps(macro.finally)}});
  if (const auto grammar = vm::ValueGrammar::Parse(macro.grammar); !grammar)
    throw ConfigFault{key + ".grammar", grammar.error().text};
  return macro;
}

vm::SlotSpec ReadSlot(const json& object, const std::string& key) {
  vm::SlotSpec slot;
  ReadObject(
      object, key,
      {{"name", Into(slot.name)},
       {"grammar", Into(slot.grammar)},
       {"initial", Into(slot.initial)},
       {"help", Into(slot.help)},
       {"auto_output", [&](const json& v, const std::string& k) { slot.auto_output = Flag(v, k); }},
       {"access", [&](const json& v, const std::string& k) {
          slot.access = OneOf<vm::Access>(
              v, k, {{"read_only", vm::Access::kReadOnly}, {"read_write", vm::Access::kReadWrite}});
        }}});
  return slot;
}

/// Checked before the text is parsed: the JSON parser and its values recurse for each level.
bool NestsTooDeep(std::string_view text) {
  constexpr int kDeepest = 8 * kMaxMacroDepth;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

template <typename Read>
auto Guarded(std::string_view text, const Read& read) -> Result<decltype(read(json()))> {
  if (NestsTooDeep(text)) return Fail(Errc::kBadValue, "too many lists and objects in each other");
  try {
    return read(json::parse(text));
  } catch (const json::exception& error) {
    return Fail(Errc::kSyntax, std::string("not JSON: ") + error.what());
  } catch (const ConfigFault& fault) {
    return Fail(Errc::kBadValue, fault.key + ": " + fault.text);
  }
}

}  // namespace

Result<Macro> ParseMacro(const std::string& name, std::string_view json_text) {
  return Guarded(json_text, [&](const json& object) {
    Macro macro = ReadMacro(name, object);
    macro.bytes = json_text.size();
    return macro;
  });
}

Result<MacroFile> ParseMacroFile(std::string_view json_text) {
  return Guarded(json_text, [](const json& root) {
    MacroFile file;
    ReadObject(root, "",
               {{"slots",
                 [&](const json& v, const std::string& k) {
                   ReadList(v, k, "a list of slots", [&](const json& slot, const std::string& at) {
                     file.slots.push_back(ReadSlot(slot, at));
                   });
                 }},
                {"macros", [&](const json& v, const std::string& k) {
                   ReadList(v, k, "a list of macros", [&](const json& macro, const std::string&) {
                     file.macros.push_back(ReadMacro(macro.value("name", ""), macro));
                   });
                 }}});
    return file;
  });
}

Result<Macro> WithLine(const Macro* macro, const std::string& name, const std::string& line) {
  auto message = MessageTemplate::Parse(line);
  if (!message) return std::unexpected(message.error());
  Macro longer = macro == nullptr ? Macro{} : *macro;
  longer.name = name;
  auto steps = std::make_shared<Steps>();
  if (longer.steps != nullptr) *steps = *longer.steps;
  if (steps->size() >= vm::kMaxMacroLines)
    return Fail(Errc::kLimit, "macro '" + name + "' would have more than " +
                                  std::to_string(vm::kMaxMacroLines) + " steps");
  steps->push_back(MacroStep{.action = SendStep{std::move(*message)}});
  longer.steps = std::move(steps);
  longer.bytes += line.size();
  return longer;
}

}  // namespace am
