#include "chat/text/tag_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "chat/text/table_lines.h"
#include "vm_protocol/core/lower_case.h"

namespace chat {
namespace {

using vm::Errc;
using vm::Fail;

constexpr std::size_t kMaxWordBytes = 64;
constexpr std::array<std::string_view, 4> kStates = {"WAITS", "HEARS", "THINKS", "SPEAKS"};

std::optional<double> NumberOf(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return {};
  return number;
}

std::string NumberText(double number) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

void ReplaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// A word without any sign that means something in a line.
bool IsPlainWord(std::string_view word) {
  return !word.empty() && word.size() <= kMaxWordBytes &&
         std::ranges::all_of(word, [](unsigned char c) {
           return c >= 0x80 || std::isalnum(c) != 0 || c == '-' || c == '_';
         });
}

}  // namespace

vm::Result<TagTable::Parameter> TagTable::ParseParameter(std::string_view text) {
  Parameter parameter;
  const std::size_t colon = text.find(':');
  if (colon == 0 || colon == std::string_view::npos) {
    return Fail(Errc::kSyntax,
                "found '" + std::string(text) +
                    "', expected NAME:WORD,WORD, NAME:LOW..HIGH or NAME:*, =USUAL behind it");
  }
  parameter.name = vm::LowerCase(text.substr(0, colon));
  std::string_view values = text.substr(colon + 1);
  if (const std::size_t equals = values.find('='); equals != std::string_view::npos) {
    parameter.usual = values.substr(equals + 1);
    values = values.substr(0, equals);
  }
  if (values == "*") {
    parameter.any_word = true;
  } else if (const std::size_t dots = values.find(".."); dots != std::string_view::npos) {
    const auto low = NumberOf(values.substr(0, dots));
    const auto high = NumberOf(values.substr(dots + 2));
    if (!low || !high || *low > *high) {
      return Fail(Errc::kBadValue,
                  "found '" + std::string(values) + "', expected two numbers LOW..HIGH");
    }
    parameter.low = *low;
    parameter.high = *high;
  } else {
    for (const std::string_view word : SplitAt(values, ","))
      parameter.words.push_back(UpperCase(word));
    if (parameter.words.empty()) {
      return Fail(Errc::kSyntax, "'" + parameter.name + "' has no values");
    }
  }
  if (!parameter.usual.empty() && !Fitting(parameter, parameter.usual)) {
    return Fail(Errc::kBadValue,
                "'" + parameter.usual + "' is none of the values of '" + parameter.name + "'");
  }
  return parameter;
}

vm::Result<Cue> TagTable::ParseCommands(std::string_view text) {
  Cue commands;
  for (const std::string_view line : SplitAt(text, "|")) {
    auto message = vm::ParseMessage(line);
    if (!message) return std::unexpected(message.error());
    if (message->to.empty()) {
      return Fail(Errc::kSyntax, "'" + std::string(line) + "' has no receiver (to @NAME)");
    }
    commands.push_back(std::move(*message));
  }
  return commands;
}

vm::Result<void> TagTable::AddRow(std::string_view head, std::string_view commands_text) {
  const auto words = SplitAt(head, " \t");
  if (words.empty()) return Fail(Errc::kSyntax, "expected a tag's name");
  if (words[0] == "silent") {
    for (std::size_t i = 1; i < words.size(); ++i) silent_.push_back(vm::LowerCase(words[i]));
    return {};
  }
  auto commands = ParseCommands(commands_text);
  if (!commands) return std::unexpected(commands.error());
  if (commands->empty()) return Fail(Errc::kSyntax, "expected | COMMAND behind the tag");
  if (words[0] == "at") {
    if (words.size() != 2 || std::ranges::find(kStates, words[1]) == kStates.end()) {
      return Fail(Errc::kSyntax, "expected at WAITS, HEARS, THINKS or SPEAKS");
    }
    states_[std::string(words[1])] = std::move(*commands);
    return {};
  }
  Row row{.parameters = {}, .commands = std::move(*commands)};
  for (std::size_t i = 1; i < words.size(); ++i) {
    auto parameter = ParseParameter(words[i]);
    if (!parameter) return std::unexpected(parameter.error());
    row.parameters.push_back(std::move(*parameter));
  }
  const std::string name = vm::LowerCase(words[0]);
  if (!tags_.emplace(name, std::move(row)).second) {
    return Fail(Errc::kBadValue, "the tag '" + name + "' is there twice");
  }
  return {};
}

vm::Result<TagTable> TagTable::Parse(const std::string& file, std::string_view text) {
  TagTable table;
  for (const TableLine& line : TableLines(text)) {
    const std::size_t bar = std::min(line.text.find('|'), line.text.size());
    const std::string_view rest = line.text.substr(std::min(bar + 1, line.text.size()));
    if (const auto added = table.AddRow(line.text.substr(0, bar), rest); !added) {
      return Fail(added.error().code, Place(file, line.number) + added.error().text);
    }
  }
  return table;
}

bool TagTable::IsSilent(std::string_view tag) const {
  return std::ranges::find(silent_, tag) != silent_.end();
}

/// The value as it goes into a command; none if it does not fit. Only words of the table, numbers
/// and plain words get through, so nothing a text says can become a part of a command.
std::optional<std::string> TagTable::Fitting(const Parameter& parameter, const std::string& value) {
  if (!parameter.words.empty()) {
    const auto found = std::ranges::find(parameter.words, UpperCase(value));
    return found == parameter.words.end() ? std::nullopt : std::optional(*found);
  }
  if (parameter.any_word) return IsPlainWord(value) ? std::optional(value) : std::nullopt;
  std::string_view digits = value;
  if (digits.ends_with('%')) digits.remove_suffix(1);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const auto number = NumberOf(digits);
  if (!number) return {};
  return NumberText(std::clamp(*number, parameter.low, parameter.high));
}

Cue TagTable::Filled(const Cue& commands, const Values& values) {
  Cue filled = commands;
  for (vm::Message& message : filled) {
    for (const auto& [name, value] : values) ReplaceAll(message.value, "$" + name, value);
  }
  return filled;
}

std::optional<Cue> TagTable::CueOf(const Tag& tag) const {
  const auto found = tags_.find(tag.name);
  if (found == tags_.end()) return {};
  const Row& row = found->second;
  Values values;
  for (const Parameter& parameter : row.parameters) {
    if (!parameter.usual.empty()) values[parameter.name] = *Fitting(parameter, parameter.usual);
  }
  std::size_t unnamed = 0;
  for (const auto& [name, value] : tag.values) {
    const auto by_name = std::ranges::find(row.parameters, name, &Parameter::name);
    const Parameter* parameter = nullptr;
    if (by_name != row.parameters.end()) parameter = &*by_name;
    if (name.empty() && unnamed < row.parameters.size()) parameter = &row.parameters[unnamed++];
    if (parameter == nullptr) continue;  // a value more than the table knows
    const auto fitting = Fitting(*parameter, value);
    if (!fitting) return {};
    values[parameter->name] = *fitting;
  }
  for (const Parameter& parameter : row.parameters) {
    if (!values.contains(parameter.name)) return {};
  }
  return Filled(row.commands, values);
}

Cue TagTable::AtState(std::string_view state, const std::string& life) const {
  const auto found = states_.find(state);
  return found == states_.end() ? Cue() : Filled(found->second, {{"life", life}});
}

}  // namespace chat
