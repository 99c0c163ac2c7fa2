#include "vm_protocol/core/message.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/nearest_word.h"
#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

constexpr std::array<std::string_view, 10> kCommandNames = {"set", "inq", "prop", "save", "rest",
                                                            "del", "def", "do",   "rep",  "tell"};
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kShownBytes = 40;  // how much of a bad word an error quotes

/// What may stand after a command's slot.
enum class ValueRule { kRequired, kForbidden, kOptional };

ValueRule RuleFor(Command command) {
  switch (command) {
    case Command::kSet:
    case Command::kProp:
    case Command::kRep:
      return ValueRule::kRequired;
    case Command::kInq:
    case Command::kDel:
    case Command::kRest:
      return ValueRule::kForbidden;
    case Command::kSave:
    case Command::kDef:
    case Command::kDo:
    case Command::kTell:
      return ValueRule::kOptional;
  }
  return ValueRule::kOptional;
}

constexpr bool IsAlnum(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool IsNameByte(char c) {
  static constexpr auto kIsNameByte = [] {
    std::array<bool, 256> known{};
    for (std::size_t byte = 0; byte < known.size(); ++byte) {
      const char sign = static_cast<char>(byte);
      known[byte] = IsAlnum(sign) || sign == '_' || sign == '-' || byte >= 0x80;
    }
    return known;
  }();
  return kIsNameByte[static_cast<unsigned char>(c)];
}

/// A module's name, or AGENT/MODULE: one of another agent.
bool IsAddress(std::string_view name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos) return IsModuleName(name);
  return IsModuleName(name.substr(0, slash)) && IsModuleName(name.substr(slash + 1));
}

std::string Quoted(std::string_view text) {
  if (text.size() <= kShownBytes) return "'" + std::string(text) + "'";
  return "'" + std::string(CutUtf8(text, kShownBytes)) + "...'";
}

/// Walks one line from left to right; every helper leaves `at_` behind what it has read.
class LineParser {
 public:
  explicit LineParser(std::string_view line) : line_(line) {}

  Result<Message> Parse() {
    SkipBlanks();
    if (AtEnd() || line_[at_] == '#' || line_.substr(at_).starts_with("//"))
      return Fail(Errc::kEmpty, "nothing but blanks or a comment");
    if (auto head = ParseIdentifiers(); !head) return std::unexpected(head.error());
    if (auto command = ParseCommand(); !command) return std::unexpected(command.error());
    if (message_.command == Command::kTell) return ParseTell();
    if (auto slot = ParseSlot(); !slot) return std::unexpected(slot.error());
    if (auto value = ParseValue(); !value) return std::unexpected(value.error());
    return std::move(message_);
  }

 private:
  bool AtEnd() const { return at_ >= line_.size(); }
  void SkipBlanks() {
    while (!AtEnd() && IsBlank(line_[at_])) ++at_;
  }
  std::string_view PeekWord() const {
    std::size_t end = at_;
    while (end < line_.size() && !IsBlank(line_[end])) ++end;
    return line_.substr(at_, end - at_);
  }
  std::unexpected<Error> Syntax(std::size_t at, std::string text) const {
    return Fail(Errc::kSyntax, std::move(text), at + 1);
  }
  std::string Found(std::size_t at) const {
    if (at >= line_.size()) return "the end of the line";
    std::size_t end = at;
    while (end < line_.size() && !IsBlank(line_[end])) ++end;
    return Quoted(line_.substr(at, std::max<std::size_t>(end - at, 1)));
  }

  /// `to` and `from`, each at most once, in either order. They are recognised only with an '@'
  /// behind them, so that no command or slot name is taken away from a module.
  Result<void> ParseIdentifiers() {
    bool seen_to = false;
    bool seen_from = false;
    while (true) {
      const std::string_view word = PeekWord();
      const bool to = EqualsIgnoringCase(word, "to");
      const bool from = EqualsIgnoringCase(word, "from");
      if (!to && !from) return {};
      const std::size_t start = at_;
      if ((to && seen_to) || (from && seen_from)) {
        return Syntax(start, "found a second '" + std::string(word) + "', expected a command");
      }
      (to ? seen_to : seen_from) = true;
      at_ += word.size();
      SkipBlanks();
      if (auto names = ParseNames(from); !names) return names;
      SkipBlanks();
    }
  }

  Result<void> ParseNames(bool from) {
    std::vector<std::string> names;
    while (true) {
      const bool at_sign = !AtEnd() && line_[at_] == '@';
      if (!at_sign && names.empty()) {
        return Syntax(at_, "found " + Found(at_) + ", expected '@' and a module's name");
      }
      const std::size_t name_at = at_;
      if (at_sign) ++at_;
      std::size_t end = at_;
      while (end < line_.size() && (IsNameByte(line_[end]) || line_[end] == '/')) ++end;
      const std::string_view name = line_.substr(at_, end - at_);
      if (!IsAddress(name)) {
        return Syntax(name_at, "found " + Found(name_at) + ", expected a module's name: " +
                                   "letters, digits, '_' or '-', at most " +
                                   std::to_string(kMaxModuleNameBytes) + " bytes");
      }
      names.emplace_back(name);
      if (names.size() > kMaxReceivers) {
        return Fail(Errc::kLimit, "more than " + std::to_string(kMaxReceivers) + " receivers",
                    name_at + 1);
      }
      at_ = end;
      if (from || AtEnd() || line_[at_] != ',') break;
      ++at_;
      SkipBlanks();
    }
    if (!AtEnd() && !IsBlank(line_[at_])) {
      return Syntax(at_, "found " + Found(at_) + ", expected a blank after the module's name");
    }
    if (from) {
      message_.from = std::move(names.front());
    } else {
      message_.to = std::move(names);
    }
    return {};
  }

  Result<void> ParseCommand() {
    const std::size_t start = at_;
    std::size_t end = at_;
    while (end < line_.size() && IsAlnum(line_[end])) ++end;
    const std::string_view word = line_.substr(start, end - start);
    const auto found = std::ranges::find(kCommandNames, word);
    const bool clean_end = end == line_.size() || IsBlank(line_[end]) || line_[end] == '#';
    if (found == kCommandNames.end() || !clean_end) {
      if (AtEnd()) return Syntax(start, "found the end of the line, expected a command");
      const std::vector<std::string> known(kCommandNames.begin(), kCommandNames.end());
      return Fail(Errc::kUnknownCommand,
                  "found " + Found(start) +
                      ", expected one of set inq prop save rest del def do rep tell" +
                      DidYouMean(word, known),
                  start + 1);
    }
    message_.command = static_cast<Command>(found - kCommandNames.begin());
    at_ = end;
    if (!AtEnd() && line_[at_] == '#') {
      const std::string_view tag_word = PeekWord().substr(1);
      if (!IsTag(tag_word)) {
        return Syntax(at_, "found tag " + Quoted(tag_word) + ", expected 1 to " +
                               std::to_string(kMaxTagBytes) +
                               " letters, digits, '_' or '-' after '#'");
      }
      message_.tag = tag_word;
      at_ += 1 + tag_word.size();
    }
    SkipBlanks();
    return {};
  }

  Result<Message> ParseTell() {
    if (AtEnd()) return Syntax(at_, "found the end of the line, expected the text to tell");
    message_.value = line_.substr(at_);
    return std::move(message_);
  }

  Result<void> ParseSlot() {
    const std::size_t start = at_;
    std::size_t end = at_;
    while (end < line_.size() && (IsNameByte(line_[end]) || line_[end] == '.')) ++end;
    const std::string_view name = line_.substr(start, end - start);
    // `do` runs files too: there the word may be a path.
    if (message_.command == Command::kDo && !IsSlotName(PeekWord())) {
      const std::string_view path = line_.substr(start);
      if (path.empty())
        return Syntax(start, "found the end of the line, expected a macro or a file");
      message_.value = path;
      at_ = line_.size();
      return {};
    }
    if (!IsSlotName(name)) {
      return Syntax(start, "found " + Found(start) + ", expected a slot name: letters, digits, " +
                               "'_' '-' and single dots, at most " + std::to_string(kMaxNameBytes) +
                               " bytes");
    }
    message_.slot = name;
    at_ = end;
    return {};
  }

  Result<void> ParseValue() {
    if (message_.command == Command::kDo && message_.slot.empty()) return {};
    const std::size_t after_slot = at_;
    SkipBlanks();
    // The original answers a question whatever comes after the slot's name.
    if (message_.command == Command::kInq && at_ > after_slot) return {};
    const ValueRule rule = RuleFor(message_.command);
    const bool sign = !AtEnd() && (line_[at_] == '=' || line_[at_] == '<');
    if (!AtEnd() && !sign) {
      const bool glued = at_ == after_slot;
      return Syntax(at_, "found " + Found(at_) + ", expected " +
                             (glued                           ? "the slot's name to end there"
                              : rule == ValueRule::kForbidden ? "the end of the line"
                                                              : "'=', '<' or '<<'"));
    }
    if (AtEnd()) {
      if (rule == ValueRule::kRequired) {
        return Syntax(
            at_, "found the end of the line, expected '= VALUE' after " + Quoted(message_.slot));
      }
      return {};
    }
    if (rule == ValueRule::kForbidden) {
      return Syntax(at_, "found " + Found(at_) + ", expected the end of the line: '" +
                             std::string(CommandName(message_.command)) + "' takes no value");
    }
    if (line_[at_] == '=') {
      message_.relation = Relation::kAssign;
      ++at_;
    } else if (at_ + 1 < line_.size() && line_[at_ + 1] == '<') {
      message_.relation = Relation::kAppend;
      at_ += 2;
    } else {
      message_.relation = Relation::kFromFile;
      ++at_;
    }
    SkipBlanks();
    message_.value = line_.substr(at_);
    return {};
  }

  std::string_view line_;
  std::size_t at_ = 0;
  Message message_;
};

bool IsLineText(std::string_view text) {
  return text.find_first_of("\r\n") == std::string_view::npos &&
         text.find('\0') == std::string_view::npos && !FirstBadUtf8(text);
}

/// True if nothing but `to RECEIVERS` or `from SENDER` stands before.
bool IsCommandPlace(std::string_view before) {
  before = Trimmed(before);
  const std::size_t blank = std::min(before.find_first_of(kBlanks), before.size());
  std::string word(before.substr(0, blank));
  std::ranges::transform(word, word.begin(), [](char c) { return static_cast<char>(c | 0x20); });
  const std::string_view rest = Trimmed(before.substr(blank));
  return before.empty() ||
         ((word == "to" || word == "from") && rest.find_first_of(kBlanks) == rest.npos);
}

}  // namespace

std::string_view CommandName(Command command) {
  return kCommandNames[static_cast<std::size_t>(command)];
}

std::string_view RelationSign(Relation relation) {
  switch (relation) {
    case Relation::kNone:
      return "";
    case Relation::kAssign:
      return "=";
    case Relation::kFromFile:
      return "<";
    case Relation::kAppend:
      return "<<";
  }
  return "";
}

bool IsSlotName(std::string_view name) {
  if (name.empty() || name.size() > kMaxNameBytes || FirstBadUtf8(name)) return false;
  bool part_empty = true;
  for (const char c : name) {
    if (c == '.') {
      if (part_empty) return false;
      part_empty = true;
    } else if (IsNameByte(c)) {
      part_empty = false;
    } else {
      return false;
    }
  }
  return !part_empty;
}

bool IsModuleName(std::string_view name) {
  return !name.empty() && name.size() <= kMaxModuleNameBytes && !FirstBadUtf8(name) &&
         std::ranges::all_of(name, IsNameByte);
}

bool IsTag(std::string_view tag) {
  return !tag.empty() && tag.size() <= kMaxTagBytes &&
         std::ranges::all_of(tag, [](char c) { return IsAlnum(c) || c == '_' || c == '-'; });
}

Result<Message> ParseMessage(std::string_view line) {
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.size() > kMaxLineBytes) {
    return Fail(Errc::kTooLong, "line of " + std::to_string(line.size()) +
                                    " bytes, expected at most " + std::to_string(kMaxLineBytes));
  }
  if (const auto bad = FirstBadUtf8(line)) {
    return Fail(Errc::kBadUtf8, "found a byte that is not UTF-8, expected UTF-8 text", *bad + 1);
  }
  // Three searches of the system's, each of many bytes at once, take less than one of our own.
  const std::size_t control = std::min({line.find('\0'), line.find('\r'), line.find('\n')});
  if (control < line.size()) {
    return Fail(Errc::kSyntax, "found a NUL, CR or LF inside the line, expected text", control + 1);
  }
  return LineParser(line).Parse();
}

std::string TagOf(std::string_view line) {
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    std::size_t word = at;
    while (word > 0 && IsAlnum(line[word - 1])) --word;
    // A command we know anywhere, or whatever stands where a command does.
    const bool command =
        std::ranges::find(kCommandNames, line.substr(word, at - word)) != kCommandNames.end() ||
        (word < at && IsCommandPlace(line.substr(0, word)));
    const std::string_view tag =
        line.substr(at + 1, line.find_first_of(" \t\r\n", at + 1) - at - 1);
    if (command && (word == 0 || IsBlank(line[word - 1])) && IsTag(tag)) return std::string(tag);
  }
  return "";
}

bool IsValid(const Message& message) {
  if (message.to.size() > kMaxReceivers || !std::ranges::all_of(message.to, IsAddress) ||
      (!message.from.empty() && !IsAddress(message.from)) ||
      (!message.tag.empty() && !IsTag(message.tag)) || !IsLineText(message.value)) {
    return false;
  }
  const bool has_value = message.relation != Relation::kNone;
  if (!message.value.empty() && IsBlank(message.value.front())) return false;
  if (message.command == Command::kTell) {
    if (!message.slot.empty() || has_value || message.value.empty()) return false;
  } else if (message.command == Command::kDo && message.slot.empty()) {
    if (has_value || message.value.empty()) return false;
    const std::string_view word =
        std::string_view(message.value).substr(0, message.value.find_first_of(" \t"));
    if (IsSlotName(word)) return false;
  } else {
    if (!IsSlotName(message.slot)) return false;
    const ValueRule rule = RuleFor(message.command);
    if (rule == ValueRule::kRequired && !has_value) return false;
    if (rule == ValueRule::kForbidden && has_value) return false;
    if (!has_value && !message.value.empty()) return false;
  }
  return FormatMessage(message).size() <= kMaxLineBytes;
}

std::string FormatMessage(const Message& message) {
  std::string line;
  constexpr std::size_t kWords = 32;  // of the identifiers, the command and the signs
  line.reserve(kWords + message.from.size() + message.tag.size() + message.slot.size() +
               message.value.size());
  if (!message.to.empty()) {
    line += "to ";
    for (std::size_t i = 0; i < message.to.size(); ++i) {
      if (i > 0) line += ',';
      line += '@';
      line += message.to[i];
    }
    line += ' ';
  }
  if (!message.from.empty()) {
    line += "From @";
    line += message.from;
    line += ' ';
  }
  line += CommandName(message.command);
  if (!message.tag.empty()) {
    line += '#';
    line += message.tag;
  }
  if (!message.slot.empty()) {
    line += ' ';
    line += message.slot;
  }
  if (message.relation != Relation::kNone) {
    line += ' ';
    line += RelationSign(message.relation);
    line += ' ';
    line += message.value;
  } else if (!message.value.empty()) {
    line += ' ';
    line += message.value;
  }
  return line;
}

Message Set(std::string slot, std::string value) {
  return {{}, "", Command::kSet, "", std::move(slot), Relation::kAssign, std::move(value)};
}
Message Inq(std::string slot) {
  return {{}, "", Command::kInq, "", std::move(slot), Relation::kNone, ""};
}
Message Rep(std::string slot, std::string value) {
  return {{}, "", Command::kRep, "", std::move(slot), Relation::kAssign, std::move(value)};
}
Message Tell(std::string text) {
  return {{}, "", Command::kTell, "", "", Relation::kNone, std::move(text)};
}
Message To(std::string module, Message message) {
  message.to = {std::move(module)};
  return message;
}

}  // namespace vm
