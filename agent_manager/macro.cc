#include "agent_manager/macro.h"

#include <functional>
#include <nlohmann/json.hpp>

#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/phonemes.h"

namespace am {
namespace {

using nlohmann::json;
using vm::Errc;
using vm::Fail;
using vm::Result;

struct MacroFault {
  std::string text;
};

std::string Text(const json& value, const std::string& where) {
  if (!value.is_string())
    throw MacroFault{where + ": found " + value.dump().substr(0, 40) + ", expected a string"};
  return value.get<std::string>();
}

std::chrono::milliseconds Milliseconds(const json& value, const std::string& where) {
  constexpr long kMost = 3'600'000;
  if (!value.is_number_integer() || value.get<long>() < 0 || value.get<long>() > kMost) {
    throw MacroFault{where + ": found " + value.dump().substr(0, 40) +
                     ", expected whole ms, 0 to 3600000"};
  }
  return std::chrono::milliseconds(value.get<long>());
}

std::map<std::string, std::string> Texts(const json& value, const std::string& where) {
  if (!value.is_object()) throw MacroFault{where + ": expected an object of strings"};
  std::map<std::string, std::string> texts;
  for (const auto& [key, member] : value.items()) texts[key] = Text(member, where + "." + key);
  return texts;
}

std::string Line(const json& value, const std::string& where) {
  const std::string line = Text(value, where);
  const auto message = vm::ParseMessage(line);
  if (!message) throw MacroFault{where + ": '" + line + "': " + message.error().text};
  if (message->to.empty())
    throw MacroFault{where + ": '" + line + "': expected a receiver, to @NAME"};
  return line;
}

constexpr int kMaxDepth = 16;  // of branches within branches

std::vector<MacroStep> ReadSteps(const json& list, const std::string& where, int depth);

/// Every member a step may have and how it is read; "kind" members choose what the step does.
MacroStep ReadStep(const json& object, const std::string& where, int depth) {
  using Kind = MacroStep::Kind;
  if (!object.is_object()) throw MacroFault{where + ": expected an object"};
  MacroStep step;
  int kinds = 0;
  const auto kind = [&](Kind which) {
    step.kind = which;
    ++kinds;
  };
  for (const auto& [key, value] : object.items()) {
    const std::string at = where + "." + key;
    if (key == "send" || key == "request") {
      kind(key == "send" ? Kind::kSend : Kind::kRequest);
      step.line = Line(value, at);
    } else if (key == "wait") {
      kind(Kind::kWait);
      if (!value.is_object()) throw MacroFault{at + ": expected an object"};
      for (const auto& [name, part] : value.items()) {
        if (name == "from")
          step.from = Text(part, at + ".from");
        else if (name == "slot")
          step.slot = Text(part, at + ".slot");
        else if (name == "value")
          step.value = Text(part, at + ".value");
        else if (name == "into")
          step.into = Text(part, at + ".into");
        else if (name == "fails_on")
          step.fails_on = Text(part, at + ".fails_on");
        else if (name == "last" && part.is_boolean())
          step.last = part.get<bool>();
        else
          throw MacroFault{at + "." + name +
                           ": unknown, expected from, slot, value, into, fails_on or last"};
      }
      if (step.from.empty() || step.slot.empty()) throw MacroFault{at + ": expected from and slot"};
    } else if (key == "follow") {
      kind(Kind::kFollow);
      const auto parts = Texts(value, at);
      if (parts.size() != 3 || !parts.contains("from") || !parts.contains("tell") ||
          !parts.contains("send")) {
        throw MacroFault{at + ": expected from, tell and send"};
      }
      step.from = parts.at("from");
      step.slot = parts.at("tell");
      step.line = Line(parts.at("send"), at + ".send");
    } else if (key == "report") {
      kind(Kind::kReport);
      const auto parts = Texts(value, at);
      if (parts.size() != 2 || !parts.contains("slot") || !parts.contains("value"))
        throw MacroFault{at + ": expected slot and value"};
      step.slot = parts.at("slot");
      step.value = parts.at("value");
    } else if (key == "pause_ms") {
      kind(Kind::kPause);
      step.limit = Milliseconds(value, at);
    } else if (key == "let") {
      kind(Kind::kLet);
      const auto parts = Texts(value, at);
      if (parts.size() != 1) throw MacroFault{at + ": expected one variable"};
      step.name = parts.begin()->first;
      step.value = parts.begin()->second;
    } else if (key == "start") {
      kind(Kind::kStart);
      step.name = Text(value, at);
    } else if (key == "need") {
      kind(Kind::kNeed);
      step.line = Text(value, at);
    } else if (key == "text") {
      step.name = Text(value, at);
    } else if (key == "remove") {
      kind(Kind::kRemove);
      step.line = Text(value, at);
    } else if (key == "parallel") {
      kind(Kind::kBranches);
      if (!value.is_array() || value.empty())
        throw MacroFault{at + ": expected a list of lists of steps"};
      for (std::size_t i = 0; i < value.size(); ++i)
        step.branches.push_back(ReadSteps(value[i], at + "[" + std::to_string(i) + "]", depth + 1));
    } else if (key == "steps") {
      kind(Kind::kBranches);
      step.branches.push_back(ReadSteps(value, at, depth + 1));
    } else if (key == "else") {
      step.otherwise = ReadSteps(value, at, depth + 1);
    } else if (key == "mark") {
      kind(Kind::kMark);
    } else if (key == "of") {
      if (!value.is_array()) throw MacroFault{at + ": expected a list of modules"};
      for (const auto& name : value) step.of.push_back(Text(name, at));
    } else if (key == "limit_ms") {
      step.limit = Milliseconds(value, at);
    } else if (key == "limit_from") {
      step.limit_from = Text(value, at);
    } else if (key == "keep") {
      step.keep = value.is_boolean() && value.get<bool>();
    } else if (key == "if_present") {
      step.if_present = Text(value, at);
    } else if (key == "when") {
      step.when = Text(value, at);
    } else if (key == "when_is") {
      step.when_is = Texts(value, at);
    } else if (key == "unless_is") {
      step.unless_is = Texts(value, at);
    } else {
      throw MacroFault{at + ": unknown member"};
    }
  }
  if (kinds != 1) {
    throw MacroFault{where +
                     ": expected exactly one of send, request, wait, pause_ms, let, start, follow, "
                     "report, need, remove, mark, steps, parallel"};
  }
  return step;
}

std::vector<MacroStep> ReadSteps(const json& list, const std::string& where, int depth) {
  if (depth > kMaxDepth)
    throw MacroFault{where + ": more than " + std::to_string(kMaxDepth) + " lists in each other"};
  if (!list.is_array()) throw MacroFault{where + ": expected a list of steps"};
  if (list.size() > vm::kMaxMacroLines)
    throw MacroFault{where + ": more than " + std::to_string(vm::kMaxMacroLines) + " steps"};
  std::vector<MacroStep> steps;
  for (std::size_t i = 0; i < list.size(); ++i)
    steps.push_back(ReadStep(list[i], where + "[" + std::to_string(i) + "]", depth));
  return steps;
}

Macro ReadMacro(const std::string& name, const json& object) {
  Macro macro;
  macro.name = name;
  if (object.is_array()) {
    macro.steps = ReadSteps(object, name, 0);
    return macro;
  }
  if (!object.is_object())
    throw MacroFault{name + ": expected a list of steps, or an object with steps"};
  for (const auto& [key, value] : object.items()) {
    const std::string at = name + "." + key;
    if (key == "name")
      macro.name = Text(value, at);
    else if (key == "grammar")
      macro.grammar = Text(value, at);
    else if (key == "help")
      macro.help = Text(value, at);
    else if (key == "status")
      macro.status = Text(value, at);
    else if (key == "stops_on")
      macro.stops_on = Text(value, at);
    else if (key == "steps")
      macro.steps = ReadSteps(value, at, 0);
    else if (key == "on_stop")
      macro.on_stop = ReadSteps(value, at, 0);
    else if (key == "finally")
      macro.finally = ReadSteps(value, at, 0);
    else
      throw MacroFault{
          at +
          ": unknown, expected name, grammar, help, status, stops_on, steps, on_stop or finally"};
  }
  return macro;
}

template <typename Read>
auto Guarded(std::string_view text, const Read& read) -> Result<decltype(read(json()))> {
  try {
    return read(json::parse(text));
  } catch (const json::exception& error) {
    return Fail(Errc::kSyntax, std::string("not JSON: ") + error.what());
  } catch (const MacroFault& fault) {
    return Fail(Errc::kBadValue, fault.text);
  }
}

}  // namespace

Result<Macro> ParseMacro(const std::string& name, std::string_view json_text) {
  return Guarded(json_text, [&](const json& object) { return ReadMacro(name, object); });
}

Result<std::vector<Macro>> ParseMacros(std::string_view json_text) {
  return Guarded(json_text, [](const json& list) {
    std::vector<Macro> macros;
    for (const auto& object : list) macros.push_back(ReadMacro(object.value("name", ""), object));
    return macros;
  });
}

void AppendLine(Macro& macro, const std::string& line) {
  MacroStep step;
  step.kind = MacroStep::Kind::kSend;
  step.line = line;
  macro.steps.push_back(step);
}

Result<std::string> Expand(std::string_view text, const Variables& variables) {
  std::string out;
  while (true) {
    const std::size_t open = text.find("${");
    out += text.substr(0, open);
    if (open == std::string_view::npos) return out;
    const std::size_t close = text.find('}', open);
    if (close == std::string_view::npos)
      return Fail(Errc::kBadValue, "'${' without '}' in '" + std::string(text) + "'");
    std::string_view inside = text.substr(open + 2, close - open - 2);
    text.remove_prefix(close + 1);
    const std::size_t fallback = inside.find(":-");
    const std::size_t filter = inside.find('|');
    const std::string name(inside.substr(0, std::min(fallback, filter)));
    const auto found = variables.find(name);
    std::string value = found == variables.end() ? "" : found->second;
    if (value.empty() && fallback != std::string_view::npos) value = inside.substr(fallback + 2);
    if (filter != std::string_view::npos) {
      if (inside.substr(filter + 1) != "plain")
        return Fail(Errc::kBadValue,
                    "unknown filter in '${" + std::string(inside) + "}', expected plain");
      const auto phonemes = vm::ParsePhonemes(value);
      if (!phonemes) return std::unexpected(phonemes.error());
      value = vm::FormatPhonemesPlain(*phonemes);
    }
    out += value;
  }
}

}  // namespace am
