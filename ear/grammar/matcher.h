#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ear/grammar/grammar.h"

/// Private to ear/grammar.
namespace ear {

/// Rules as a recursive transition network: states whose arcs take a word, take nothing, or go
/// through another rule. Repeats are copies. Borrows the rules, which must outlive it.
class Network {
 public:
  /// REQUIRES: checked rules (Grammar::Make).
  Network(const Grammar::Rules& rules, std::string_view root);

  /// The tags of the first way (alternatives in order, repeats as often as can be) in which all the
  /// words fit. Each rule, place and state is looked at once: time grows with states times the cube
  /// of the text at worst, and ends at kMaxMatchSteps.
  std::optional<std::vector<std::string>> Match(const std::vector<std::string>& words) const;

 private:
  friend class Walk;
  using Id = std::uint32_t;
  enum class Op { kWord, kAny, kTag, kCall, kFork, kEnd, kFail };
  struct State {
    Op op = Op::kFail;
    Id next = 0;
    Id other = 0;                       ///< kFork: tried after next; kCall: the rule
    const std::string* text = nullptr;  ///< kWord, kTag
  };
  struct Rule {
    Id first = 0, entry = 0;  ///< its states are `first` and those behind it, `count` in all
    std::size_t count = 0;
  };

  Id Add(State state);
  Id Build(const Node& node, Id next);

  std::vector<State> states_;
  std::vector<Rule> rules_;
  std::map<std::string_view, Id> numbers_;
  Id root_ = 0;
};

}  // namespace ear
