#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "agent_manager/access/pattern.h"
#include "agent_manager/access/role.h"
#include "agent_manager/routing/envelope.h"
#include "agent_manager/routing/limits.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// What happens to messages on their way. A rule matches when everything it names matches; in
/// names, slots and values `*` stands for any text, and the case of values does not count. What a
/// macro says matches `from` as the macro layer and as who started the macro. The members in JSON:
/// docs/configuration.md.
struct Rule {
  // Which messages.
  std::string name;  ///< for people; "rule 3" if none was given
  std::vector<std::string> from, to, command, slot, value;  ///< any of them; empty = all
  std::vector<Role> role;                                   ///< of the sender; empty = all
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
  struct Sender {
    std::string name;
    std::string starter;  ///< of the macro that says it; empty: it is no macro
    Role role = Role::kOwner;
    PeerKey peer = kHub;  ///< a peer is counted by this, whatever it calls itself; machines by name
  };
  /// Applies the rules in order to a message on its way to `to` (empty: a report to whoever hears
  /// it), and changes both as the rules say. A value that is read from a file or appended to what
  /// is there is not known here: rules that drop or refuse by value match it.
  Outcome Apply(const Sender& from, std::string& to, vm::Message& message, vm::Time now);

 private:
  struct Live {
    Rule rule;
    std::map<std::string, RateMeter> machine_meters;  // by name
    std::map<PeerKey, RateMeter> peer_meters;
  };
  std::vector<Live> rules_;
};

}  // namespace am
