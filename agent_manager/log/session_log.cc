#include "agent_manager/log/session_log.h"

#include <array>

#include "vm_protocol/core/utf8.h"

namespace am {

std::string FormatLogEntry(const LogEntry& entry) {
  // Tabs within the line itself need no escape: it is the last field.
  return vm::FormatMs(entry.time) + "\t" + entry.sender + "\t" +
         (entry.receivers.empty() ? "-" : entry.receivers) + "\t" + entry.line;
}

vm::Result<LogEntry> ParseLogEntry(std::string_view line) {
  if (line.empty() || line.starts_with('#')) return vm::Fail(vm::Errc::kEmpty, "a comment");
  std::array<std::string_view, 3> fields;
  for (auto& field : fields) {
    const std::size_t tab = line.find('\t');
    if (tab == std::string_view::npos) {
      return vm::Fail(vm::Errc::kSyntax,
                      "found '" + std::string(vm::CutUtf8(line, 40)) +
                          "', expected time, sender, receivers and line, with tabs between");
    }
    field = line.substr(0, tab);
    line.remove_prefix(tab + 1);
  }
  const auto time = vm::ParseMs(fields[0]);
  if (!time) return std::unexpected(time.error());
  return LogEntry{*time, std::string(fields[1]), std::string(fields[2]), std::string(line)};
}

}  // namespace am
