#include <algorithm>
#include <string>

#include "vm_protocol/core/slot.h"

namespace vm {
namespace {

std::string_view AccessName(Access access) {
  switch (access) {
    case Access::kReadOnly:
      return "ReadOnly";
    case Access::kReadWrite:
      return "ReadWrite";
    case Access::kWriteOnly:
      return "WriteOnly";
  }
  return "";
}

std::string InTable(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

}  // namespace

std::string SlotMachine::Slot::Help() const {
  return spec.help +
         (spec.access == Access::kReadOnly ? " (read only)" : " Value: " + spec.grammar);
}

std::string SlotMachine::Slot::Attributes() const {
  std::string text = auto_output ? "AutoOutput" : "NoAutoOutput";
  text += ' ';
  text += AccessName(spec.access);
  if (!spec.initial.empty()) text += " default " + spec.initial;
  return text;
}

std::string SlotMachine::DocsMarkdown() const {
  std::string text =
      "| slot | value | access | AutoOutput | at start | meaning |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const auto& slot : slots_) {
    const SlotSpec& spec = slot->spec;
    const auto code = [](const std::string& s) { return s.empty() ? s : "`" + InTable(s) + "`"; };
    text += "| `" + spec.name + "` | " + code(spec.grammar) + " | " +
            std::string(AccessName(spec.access)) + " | " + (spec.auto_output ? "on" : "off") +
            " | " + code(spec.initial) + " | " + InTable(spec.help) + " |\n";
  }
  return text;
}

std::string_view ErrcName(Errc code) {
  switch (code) {
    case Errc::kEmpty:
      return "EMPTY";
    case Errc::kSyntax:
      return "SYNTAX";
    case Errc::kTooLong:
      return "TOO_LONG";
    case Errc::kBadUtf8:
      return "BAD_UTF8";
    case Errc::kUnknownCommand:
      return "UNKNOWN_COMMAND";
    case Errc::kUnknownSlot:
      return "UNKNOWN_SLOT";
    case Errc::kAccess:
      return "ACCESS";
    case Errc::kBadValue:
      return "BAD_VALUE";
    case Errc::kBusy:
      return "BUSY";
    case Errc::kUnknownModule:
      return "UNKNOWN_MODULE";
    case Errc::kUnavailable:
      return "UNAVAILABLE";
    case Errc::kTimeout:
      return "TIMEOUT";
    case Errc::kStopped:
      return "STOPPED";
    case Errc::kLimit:
      return "LIMIT";
    case Errc::kInternal:
      return "INTERNAL";
  }
  return "INTERNAL";
}

std::string FormatError(const Error& error) {
  std::string text(ErrcName(error.code));
  if (error.column > 0) text += " column " + std::to_string(error.column) + ":";
  text += " " + error.text;
  std::ranges::replace(text, '\n', ' ');
  std::ranges::replace(text, '\r', ' ');
  return text;
}

}  // namespace vm
