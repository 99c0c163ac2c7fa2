#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/log/session_log.h"
#include "vm_protocol/core/message.h"

namespace am {

/// A line of a session log, taken apart.
struct Entry {
  LogEntry log;
  vm::Message message;                 ///< `tell` with the whole line where it was none
  std::vector<std::string> receivers;  ///< empty: nobody heard it
};

/// Which entries somebody wants to see; empty = all. `*` in a pattern stands for any text.
struct Selection {
  std::vector<std::string> from{}, to{}, slot{}, command{};
  std::string text{};  ///< somewhere in the line
  std::optional<vm::Time> since{}, until{};
};

/// The entries of a log. Lines that are none are counted in `bad`.
std::vector<Entry> ParseLog(std::string_view text, std::size_t& bad);
bool Selects(const Selection& selection, const Entry& entry);

/// A tagged request and its answer.
struct Exchange {
  vm::Time asked{0};
  std::optional<vm::Time> answered;  ///< none: it never was
  std::string from, to, slot;
  bool refused = false;
};
std::vector<Exchange> FindExchanges(const std::vector<Entry>& entries);

/// A table of how long answers took, by receiver and slot: count, median, 95th percentile, longest,
/// refusals, unanswered. In ms.
std::string DelayTable(const std::vector<Exchange>& exchanges);

/// A picture of who said what when: a lane for each party, time to the right, a mark for each
/// message (its text under the pointer) and a bar for each request until its answer.
std::string TimelineSvg(const std::vector<Entry>& entries, const std::vector<Exchange>& exchanges);

}  // namespace am
