#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// One line of a session log: what was said, when, by whom, to whom. Fields are separated by tabs:
///   TIME_MS <tab> SENDER <tab> RECEIVER[,RECEIVER...] or - <tab> LINE
/// Lines starting with '#' are comments; the first names the format. Of a line that somebody had
/// said by `do FILE` the sender is NAME:do.
struct LogEntry {
  static constexpr std::string_view kByScript = ":do";
  vm::Time time{0};
  std::string sender;
  std::string receivers;  ///< "-": nobody heard it
  std::string line;       ///< as it came in, `to` included
  bool IsOfScript() const { return sender.ends_with(kByScript); }
  bool operator==(const LogEntry&) const = default;
};

std::string FormatLogEntry(const LogEntry& entry);
/// Errors: kEmpty (comment), kSyntax.
vm::Result<LogEntry> ParseLogEntry(std::string_view line);

/// Where the hub writes what passes. A log without a sink costs nothing.
class SessionLog {
 public:
  using Sink = std::function<void(std::string_view line)>;
  SessionLog() = default;
  explicit SessionLog(Sink sink) : sink_(std::move(sink)) {
    sink_("# galatea session log 1: ms, sender, receivers, line");
  }
  bool enabled() const { return on_ && sink_ != nullptr; }
  /// A log nobody reads at the moment costs nothing either.
  void set_enabled(bool on) { on_ = on; }
  void Write(vm::Time time, std::string_view sender, std::string_view receivers,
             std::string_view line) const {
    if (enabled())
      sink_(FormatLogEntry({time, std::string(sender), std::string(receivers), std::string(line)}));
  }

 private:
  Sink sink_;
  bool on_ = true;
};

}  // namespace am
