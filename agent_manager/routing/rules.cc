#include "agent_manager/routing/rules.h"

#include <algorithm>

#include "vm_protocol/core/blanks.h"

namespace am {

namespace {

constexpr std::size_t kMaxMeters = 4096;  // senders one throttling rule remembers

bool AnyOf(const std::vector<std::string>& patterns, std::string_view text) {
  return patterns.empty() || AnyMatches(patterns, text);
}

bool ValueMatches(const Rule& rule, const vm::Message& message) {
  if (rule.value.empty()) return true;
  const bool unseen =
      message.relation == vm::Relation::kFromFile || message.relation == vm::Relation::kAppend;
  if (unseen && (rule.drop || !rule.refuse.empty())) return true;
  return std::ranges::any_of(rule.value, [&](const std::string& pattern) {
    return MatchesIgnoringCase(pattern, vm::Trimmed(message.value));
  });
}

bool Matches(const Rule& rule, const Rules::Sender& from, const std::string& to,
             const vm::Message& message) {
  return AnyOf(rule.command, vm::CommandName(message.command)) && AnyOf(rule.slot, message.slot) &&
         (AnyOf(rule.from, from.name) ||
          (!from.starter.empty() && AnyOf(rule.from, from.starter))) &&
         (rule.role.empty() || std::ranges::find(rule.role, from.role) != rule.role.end()) &&
         AnyOf(rule.to, to) && ValueMatches(rule, message);
}

/// ${from}, ${to}, ${slot} and ${value} are the message's own.
std::string Fill(std::string_view text, const std::string& from, const std::string& to,
                 const vm::Message& message) {
  std::string out;
  while (!text.empty()) {
    const std::size_t open = text.find("${");
    const std::size_t close = open == std::string_view::npos ? open : text.find('}', open);
    if (close == std::string_view::npos) break;
    out += text.substr(0, open);
    const std::string_view word = text.substr(open + 2, close - open - 2);
    if (word == "from") out += from;
    if (word == "to") out += to;
    if (word == "slot") out += message.slot;
    if (word == "value") out += message.value;
    text.remove_prefix(close + 1);
  }
  return out.append(text);
}

}  // namespace

void Rules::set_rules(std::vector<Rule> rules) {
  rules_.clear();
  for (Rule& rule : rules) rules_.push_back({std::move(rule), {}, {}});
}

Rules::Outcome Rules::Apply(const Sender& sender, std::string& to, vm::Message& message,
                            vm::Time now) {
  const std::string& from = sender.name;
  Outcome outcome;
  for (Live& live : rules_) {
    const Rule& rule = live.rule;
    if (!Matches(rule, sender, to, message)) continue;
    if (rule.note)
      outcome.notes.push_back(rule.name + ": @" + from + " " + vm::FormatMessage(message));
    for (const std::string& receiver : rule.copy_to) outcome.copies.emplace_back(receiver, message);
    vm::Message changed = message;
    const std::string receiver = rule.new_to ? Fill(*rule.new_to, from, to, message) : to;
    if (rule.new_slot) changed.slot = Fill(*rule.new_slot, from, to, message);
    if (rule.new_value) {
      changed.value = Fill(*rule.new_value, from, to, message);
      if (changed.relation == vm::Relation::kNone && !changed.value.empty() &&
          changed.command != vm::Command::kTell)
        changed.relation = vm::Relation::kAssign;
    }
    if (!vm::IsValid(changed)) {
      outcome.dropped = rule.name + " makes a line of it that is no message";
      return outcome;
    }
    message = std::move(changed);
    to = receiver;
    outcome.delay += rule.delay;
    if (rule.drop || !rule.refuse.empty()) {
      outcome.dropped = rule.refuse.empty() ? "dropped by " + rule.name : rule.refuse;
      return outcome;
    }
    if (rule.per_s > 0) {
      if (live.peer_meters.size() >= kMaxMeters && !live.peer_meters.contains(sender.peer))
        live.peer_meters.clear();
      RateMeter& meter =
          sender.peer == kHub ? live.machine_meters[from] : live.peer_meters[sender.peer];
      const RateMeter before = meter;
      if (meter.Take(1, rule.per_s, now) > vm::Time(0)) {
        meter = before;  // what is dropped does not count
        outcome.dropped = rule.name + ": more than " + std::to_string(rule.per_s) + " a second";
        return outcome;
      }
    }
    if (rule.last) break;
  }
  return outcome;
}

}  // namespace am
