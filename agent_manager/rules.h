#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "agent_manager/limits.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// What happens to messages on their way. A rule matches when everything it names matches; in
/// names, slots and values `*` stands for any text. The members in JSON: docs/configuration.md.
struct Rule {
  // Which messages.
  std::string name;  ///< for people; "rule 3" if none was given
  std::vector<std::string> from, to, command, slot, value;  ///< any of them; empty = all
  // What happens, in this order.
  std::vector<std::string> copy_to;  ///< receivers of a copy of the message as it came
  std::optional<std::string> new_to, new_slot, new_value;  ///< ${value} and so on are put in
  bool drop = false;
  std::string refuse;  ///< drop, and this is the answer
  std::chrono::milliseconds delay{0};
  std::uint64_t per_s = 0;  ///< beyond: dropped; counted for each sender
  bool note = false;        ///< a notice for people
  bool last = false;        ///< later rules do not see the message

  bool operator==(const Rule&) const = default;
};

/// `*` in the pattern stands for any text, also none. Case counts.
bool MatchesPattern(std::string_view pattern, std::string_view text);

/// The rules at work. Thread: one. Limits: kMaxRules rules.
class Rules {
 public:
  static constexpr std::size_t kMaxRules = 1000;
  struct Outcome {
    std::optional<std::string> dropped;  ///< by which rule, with its reason
    vm::Time delay{0};
    std::vector<std::pair<std::string, vm::Message>> copies;  ///< receiver, message
    std::vector<std::string> notes;
  };

  void set_rules(std::vector<Rule> rules);
  bool empty() const { return rules_.empty(); }
  /// Applies the rules in order to a message on its way from `from` to `to` (empty: a report to
  /// whoever hears it), and changes both as the rules say.
  Outcome Apply(const std::string& from, std::string& to, vm::Message& message, vm::Time now);

 private:
  struct Live {
    Rule rule;
    std::map<std::string, RateMeter> meters;  // by sender
  };
  std::vector<Live> rules_;
};

}  // namespace am
