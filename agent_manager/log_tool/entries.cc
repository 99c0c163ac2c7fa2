#include "agent_manager/log_tool/entries.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "agent_manager/access/pattern.h"

namespace am {
namespace {

std::vector<std::string> Split(std::string_view names) {
  std::vector<std::string> parts;
  if (names == "-") return parts;
  while (!names.empty()) {
    const std::size_t comma = std::min(names.find(','), names.size());
    parts.emplace_back(names.substr(0, comma));
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return parts;
}

bool Any(const std::vector<std::string>& patterns, std::string_view text) {
  return patterns.empty() ||
         std::ranges::any_of(patterns, [&](const auto& p) { return MatchesPattern(p, text); });
}

std::string Column(const std::string& text, std::size_t width, bool right = false) {
  const std::string blanks(text.size() < width ? width - text.size() : 0, ' ');
  return right ? blanks + text : text + blanks;
}

}  // namespace

std::vector<Entry> ParseLog(std::string_view text, std::size_t& bad) {
  std::vector<Entry> entries;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto log = ParseLogEntry(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!log) {
      if (log.error().code != vm::Errc::kEmpty) ++bad;
      continue;
    }
    const auto message = vm::ParseMessage(log->line);
    entries.push_back({*log, message ? *message : vm::Tell(log->line), Split(log->receivers)});
  }
  return entries;
}

bool Selects(const Selection& selection, const Entry& entry) {
  if (selection.since && entry.log.time < *selection.since) return false;
  if (selection.until && entry.log.time > *selection.until) return false;
  if (!Any(selection.from, entry.log.sender)) return false;
  if (!selection.to.empty() && std::ranges::none_of(entry.receivers, [&](const auto& name) {
        return Any(selection.to, name);
      }))
    return false;
  if (!Any(selection.slot, entry.message.slot)) return false;
  if (!Any(selection.command, vm::CommandName(entry.message.command))) return false;
  return entry.log.line.find(selection.text) != std::string::npos;
}

std::vector<Exchange> FindExchanges(const std::vector<Entry>& entries) {
  std::vector<Exchange> exchanges;
  // (asker, asked, tag) -> index of the open request; an answered tag may be used again.
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> open;
  for (const Entry& entry : entries) {
    const vm::Message& message = entry.message;
    if (message.tag.empty()) continue;
    for (const std::string& receiver : entry.receivers) {
      if (message.command != vm::Command::kRep) {
        open[{entry.log.sender, receiver, message.tag}] = exchanges.size();
        exchanges.push_back(
            {entry.log.time, std::nullopt, entry.log.sender, receiver, message.slot, false});
        continue;
      }
      const auto asked = open.find({receiver, entry.log.sender, message.tag});
      if (asked == open.end()) continue;
      Exchange& exchange = exchanges[asked->second];
      exchange.refused = message.slot == exchange.slot + ".error";
      if (!exchange.refused && message.slot != exchange.slot) continue;  // one slot of a group
      exchange.answered = entry.log.time;
      open.erase(asked);
    }
  }
  return exchanges;
}

std::string DelayTable(const std::vector<Exchange>& exchanges) {
  struct Row {
    std::vector<vm::Time> delays;
    std::size_t refused = 0, unanswered = 0;
  };
  std::map<std::pair<std::string, std::string>, Row> rows;
  for (const Exchange& exchange : exchanges) {
    Row& row = rows[{exchange.to, exchange.slot}];
    if (exchange.answered) row.delays.push_back(*exchange.answered - exchange.asked);
    row.refused += exchange.refused ? 1 : 0;
    row.unanswered += exchange.answered ? 0 : 1;
  }
  std::string table = Column("receiver", 16) + Column("slot", 24);
  for (const char* name : {"count", "median", "p95", "longest", "refused", "unanswered"})
    table += Column(name, 12, true);
  table += "\n";
  for (auto& [key, row] : rows) {
    std::ranges::sort(row.delays);
    const auto at = [&row](double share) {
      if (row.delays.empty()) return std::string("-");
      return vm::FormatMs(row.delays[static_cast<std::size_t>(
          share * static_cast<double>(row.delays.size() - 1) + 0.5)]);
    };
    table += Column(key.first, 16) + Column(key.second, 24);
    for (const std::string& cell :
         {std::to_string(row.delays.size() + row.unanswered), at(0.5), at(0.95), at(1.0),
          std::to_string(row.refused), std::to_string(row.unanswered)})
      table += Column(cell, 12, true);
    table += "\n";
  }
  return table;
}

}  // namespace am
