#include "task_manager/platform/input_script.h"

#include <charconv>
#include <map>

#include "task_manager/document/values.h"
#include "vm_protocol/xml/node.h"

namespace vxml {
namespace {

constexpr std::size_t kMaxCommands = 100'000;

std::string TakeWord(std::string_view& rest) {
  rest = vm::xml::Trim(rest);
  const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
  std::string word(rest.substr(0, end));
  rest.remove_prefix(end);
  rest = vm::xml::Trim(rest);
  return word;
}

/// name=value words in front of the rest.
vm::Result<void> TakeOptions(std::string_view& rest, Command& command, double& confidence) {
  while (true) {
    std::string_view ahead = rest;
    const std::string word = TakeWord(ahead);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) return {};
    const std::string name = word.substr(0, equals);
    const std::string value = word.substr(equals + 1);
    if (name == "at" || name == "gap") {
      const auto time = ParseTime(value);
      if (!time)
        return vm::Fail(vm::Errc::kSyntax, name + "='" + value + "', expected a time as 300ms");
      if (name == "at") {
        command.at = *time;
      } else {
        command.gap = *time;
      }
    } else if (name == "confidence") {
      const auto read = std::from_chars(value.data(), value.data() + value.size(), confidence);
      if (read.ec != std::errc() || confidence < 0 || confidence > 1) {
        return vm::Fail(vm::Errc::kSyntax, "confidence '" + value + "', expected 0 to 1");
      }
    } else if (name == "key") {
      command.word = value;
    } else {
      return {};  // words with '=' in them
    }
    rest = ahead;
  }
}

vm::Result<void> Say(std::string_view rest, Command& command) {
  while (true) {
    const std::size_t bar = rest.find("||");
    std::string_view part = rest.substr(0, bar);
    double confidence = 1.0;
    if (auto done = TakeOptions(part, command, confidence); !done) return done;
    if (vm::xml::IsBlank(part)) return vm::Fail(vm::Errc::kSyntax, "say: words expected");
    command.hypotheses.push_back({std::string(vm::xml::Trim(part)), confidence});
    if (bar == std::string_view::npos) return {};
    rest.remove_prefix(bar + 2);
  }
}

vm::Result<void> Keys(std::string_view rest, Command& command) {
  double unused = 1;
  if (auto done = TakeOptions(rest, command, unused); !done) return done;
  std::string keys;
  for (const char c : rest) {
    if (c == ' ' || c == '\t') continue;
    if (std::string_view("0123456789*#ABCDabcd").find(c) == std::string_view::npos) {
      return vm::Fail(vm::Errc::kSyntax, std::string("dtmf: '") + c + "' is no key");
    }
    keys += c;
  }
  if (keys.empty()) return vm::Fail(vm::Errc::kSyntax, "dtmf: keys expected");
  command.hypotheses.push_back({keys, 1.0});
  return {};
}

vm::Result<void> Record(std::string_view rest, Command& command) {
  const std::string length = TakeWord(rest);
  const auto time = ParseTime(length);
  if (!time) return vm::Fail(vm::Errc::kSyntax, "record: a length as 3s expected");
  command.duration = *time;
  double unused = 1;
  return TakeOptions(rest, command, unused);
}

vm::Result<void> Transfer(std::string_view rest, Command& command) {
  command.word = TakeWord(rest);
  if (command.word.empty()) return vm::Fail(vm::Errc::kSyntax, "transfer: an outcome expected");
  if (!rest.empty()) {
    const auto time = ParseTime(rest);
    if (!time) return vm::Fail(vm::Errc::kSyntax, "transfer: a length as 3s expected");
    command.duration = *time;
  }
  return {};
}

}  // namespace

vm::Result<Command> ParseCommand(std::string_view line) {
  using Kind = Command::Kind;
  static const std::map<std::string, Kind> kKinds = {
      {"say", Kind::kSay},         {"dtmf", Kind::kDtmf},        {"silence", Kind::kSilence},
      {"nomatch", Kind::kNoMatch}, {"toolong", Kind::kTooLong},  {"hangup", Kind::kHangup},
      {"record", Kind::kRecord},   {"transfer", Kind::kTransfer}};
  std::string_view rest = vm::xml::Trim(line);
  if (rest.empty() || rest[0] == '#') return vm::Fail(vm::Errc::kEmpty, "");
  const std::string word = TakeWord(rest);
  const auto found = kKinds.find(word);
  if (found == kKinds.end()) {
    return vm::Fail(vm::Errc::kSyntax, "'" + word +
                                           "', expected say, dtmf, silence, nomatch, toolong, "
                                           "hangup, record or transfer");
  }
  Command command;
  command.kind = found->second;
  vm::Result<void> done;
  double unused = 1;
  switch (command.kind) {
    case Kind::kSay:
      done = Say(rest, command);
      break;
    case Kind::kDtmf:
      done = Keys(rest, command);
      break;
    case Kind::kRecord:
      done = Record(rest, command);
      break;
    case Kind::kTransfer:
      done = Transfer(rest, command);
      break;
    default:
      done = TakeOptions(rest, command, unused);
      if (done && !rest.empty()) {
        done = vm::Fail(vm::Errc::kSyntax, word + ": '" + std::string(rest) + "' is not expected");
      }
  }
  if (!done) return std::unexpected(done.error());
  return command;
}

vm::Result<std::vector<Command>> ParseInputScript(std::string_view text, const std::string& name) {
  std::vector<Command> commands;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    auto command = ParseCommand(line);
    if (!command) {
      if (command.error().code == vm::Errc::kEmpty) continue;
      return vm::Fail(command.error().code,
                      name + ":" + std::to_string(number) + ": " + command.error().text);
    }
    if (commands.size() >= kMaxCommands) {
      return vm::Fail(vm::Errc::kLimit,
                      name + ": more than " + std::to_string(kMaxCommands) + " lines");
    }
    command->line = number;
    commands.push_back(std::move(*command));
  }
  return commands;
}

}  // namespace vxml
