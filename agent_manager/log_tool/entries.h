#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/log/session_log.h"
#include "vm_protocol/core/message.h"

namespace am {

/// One parsed line of a session log.
struct Entry {
  LogEntry log;
  vm::Message message;                 ///< a `tell` with the whole line if it cannot be parsed
  std::vector<std::string> receivers;  ///< empty: the hub passed it to nobody
};

/// The entries to show: those that match every member. An empty list matches all entries, and `*`
/// in a pattern matches any text.
struct Selection {
  std::vector<std::string> from{}, to{}, slot{}, command{};
  std::string text{};  ///< contained in the line
  std::optional<vm::Time> since{}, until{};
};

/// Parses a session log. Adds the number of lines that are not entries to `bad`; empty lines are
/// skipped.
std::vector<Entry> ParseLog(std::string_view text, std::size_t& bad);
bool Selects(const Selection& selection, const Entry& entry);

/// A tagged request and its answer.
struct Exchange {
  vm::Time asked{0};
  std::optional<vm::Time> answered;  ///< none: the log has no answer
  std::string from, to, slot;
  bool refused = false;
};
/// Pairs tagged requests with their answers, in the order of the requests.
std::vector<Exchange> FindExchanges(const std::vector<Entry>& entries);

/// Returns a table of response times in ms, one row for each receiver and slot: count, median, 95th
/// percentile, longest, refused, unanswered.
std::string DelayTable(const std::vector<Exchange>& exchanges);

/// Draws the log as an SVG picture: a lane for each peer, time to the right, a mark for each
/// message (its text is the tooltip) and a bar from each request to its answer.
std::string TimelineSvg(const std::vector<Entry>& entries, const std::vector<Exchange>& exchanges);

}  // namespace am
