#include "ear/grammar/matcher.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "ear/grammar/grammar_limits.h"
#include "vm_protocol/core/utf8.h"

namespace ear {

Network::Network(const Grammar::Rules& rules, std::string_view root) {
  for (const auto& [name, node] : rules) {
    numbers_.emplace(name, static_cast<Id>(numbers_.size()));
  }
  for (const auto& [name, node] : rules) {
    Rule rule{.first = Add({.op = Op::kEnd})};
    rule.entry = Build(node, rule.first);
    rule.count = states_.size() - rule.first;
    rules_.push_back(rule);
  }
  root_ = numbers_.at(root);
}

Network::Id Network::Add(State state) {
  states_.push_back(state);
  return static_cast<Id>(states_.size() - 1);
}

/// The state where a node begins that goes on at `next`: built from its end to its beginning.
Network::Id Network::Build(const Node& node, Id next) {
  switch (node.kind) {
    case Node::Kind::kWord:
      return Add({.op = Op::kWord, .next = next, .text = &node.text});
    case Node::Kind::kAny:
      return Add({.op = Op::kAny, .next = next});
    case Node::Kind::kTag:
      return Add({.op = Op::kTag, .next = next, .text = &node.text});
    case Node::Kind::kRule:
      return Add({.op = Op::kCall, .next = next, .other = numbers_.at(node.text)});
    case Node::Kind::kVoid:
      return Add({.op = Op::kFail});
    case Node::Kind::kSequence:
      for (auto part = node.parts.rbegin(); part != node.parts.rend(); ++part) {
        next = Build(*part, next);
      }
      return next;
    case Node::Kind::kChoice: {
      Id first = Build(node.parts.back(), next);
      for (std::size_t i = node.parts.size() - 1; i-- > 0;) {
        const Id entry = Build(node.parts[i], next);
        first = Add({.op = Op::kFork, .next = entry, .other = first});
      }
      return first;
    }
    case Node::Kind::kRepeat: {
      Id first = next;
      if (node.most == kUnlimited) {
        first = Add({.op = Op::kFork, .other = next});
        const Id again = Build(node.parts[0], first);
        states_[first].next = again;
      }
      for (int i = node.least; i < node.most; ++i) {
        const Id once = Build(node.parts[0], first);
        first = Add({.op = Op::kFork, .next = once, .other = next});
      }
      for (int i = 0; i < node.least; ++i) first = Build(node.parts[0], first);
      return first;
    }
  }
  return next;
}

/// One text on its way through the network.
class Walk {
 public:
  Walk(const Network& network, const std::vector<std::string>& words) : network_(network) {
    for (const std::string& word : words) {
      starts_.push_back(text_.size());
      text_ += word;
    }
    starts_.push_back(text_.size());
  }

  std::optional<std::vector<std::string>> Run() {
    if (text_.size() > kMaxMatchBytes) return std::nullopt;
    for (const Way& way : Ways(network_.root_, 0)) {
      if (way.end != text_.size()) continue;
      std::vector<std::string> tags;
      std::size_t bytes = 0;
      if (steps_ > kMaxMatchSteps || !Read(way.tags, tags, bytes)) break;
      return tags;
    }
    return std::nullopt;
  }

 private:
  using Id = Network::Id;
  using Op = Network::Op;
  /// A list from its end: one tag, or all that a rule inside told.
  struct Tags {
    const Tags* before = nullptr;
    const std::string* text = nullptr;
    const Tags* inside = nullptr;
  };
  /// Where a rule can end, and the tags of the first way there.
  struct Way {
    std::size_t end = 0;
    const Tags* tags = nullptr;
  };
  struct Place {
    Id state = 0;
    std::size_t at = 0;
    const Tags* tags = nullptr;
  };

  const Tags* Behind(const Tags* before, const std::string* text, const Tags* inside) {
    if (text == nullptr && inside == nullptr) return before;
    return &tags_.emplace_back(Tags{before, text, inside});
  }

  /// The places where a rule begun at `at` can end, in the order in which they are first reached.
  const std::vector<Way>& Ways(Id rule_number, std::size_t at) {
    const auto [known, is_new] = ways_.try_emplace({rule_number, at});
    std::vector<Way>& ways = known->second;
    const Network::Rule& rule = network_.rules_[rule_number];
    const std::size_t columns = text_.size() - at + 1;
    if (is_new) steps_ += rule.count * columns / 64;
    if (!is_new || steps_ > kMaxMatchSteps || nesting_ >= kMaxMatchNesting) return ways;
    ++nesting_;
    std::vector<bool> seen(rule.count * columns);
    std::vector<Place> left = {{rule.entry, at, nullptr}};
    while (!left.empty() && ++steps_ <= kMaxMatchSteps) {
      const Place place = left.back();
      left.pop_back();
      const std::size_t cell = (place.state - rule.first) * columns + (place.at - at);
      if (seen[cell]) continue;
      seen[cell] = true;
      if (network_.states_[place.state].op == Op::kEnd) {
        ways.push_back({place.at, place.tags});
      } else {
        const std::size_t before = left.size();
        Step(place, left);
        std::reverse(left.begin() + static_cast<std::ptrdiff_t>(before), left.end());
        steps_ += left.size() - before;
      }
    }
    --nesting_;
    return ways;
  }

  /// Adds the places that can be reached from one, the preferred one first.
  void Step(const Place& place, std::vector<Place>& left) {
    const Network::State& state = network_.states_[place.state];
    switch (state.op) {
      case Op::kWord: {
        const std::size_t end = place.at + state.text->size();
        if (text_.compare(place.at, state.text->size(), *state.text) != 0) return;
        // Only Latin words have blanks between them.
        const bool latin = static_cast<unsigned char>(state.text->back()) < 0x80;
        if (!latin || std::binary_search(starts_.begin(), starts_.end(), end)) {
          left.push_back({state.next, end, place.tags});
        }
        return;
      }
      case Op::kAny:
        return Any(place, state.next, left);
      case Op::kTag:
        left.push_back({state.next, place.at, Behind(place.tags, state.text, nullptr)});
        return;
      case Op::kCall:
        for (const Way& way : Ways(state.other, place.at)) {
          left.push_back({state.next, way.end, Behind(place.tags, nullptr, way.tags)});
        }
        return;
      case Op::kFork:
        left.push_back({state.next, place.at, place.tags});
        left.push_back({state.other, place.at, place.tags});
        return;
      case Op::kEnd:
      case Op::kFail:
        return;
    }
  }

  /// The rest of a word, and as many more as are needed, the fewest first; of one without blanks
  /// around its parts (Japanese) also less.
  void Any(const Place& place, Id next, std::vector<Place>& left) {
    const auto stop = std::upper_bound(starts_.begin(), starts_.end(), place.at);
    if (stop == starts_.end()) return;
    left.push_back({next, *stop, place.tags});
    left.push_back({place.state, *stop, place.tags});
    // One stand-in can be several words that were not understood.
    if (text_.compare(place.at, *stop - place.at, kNotUnderstood) == 0) {
      left.push_back({next, place.at, place.tags});
    }
    if (static_cast<unsigned char>(text_[place.at]) < 0x80) return;
    for (std::size_t end = *stop - 1; end > place.at; --end) {
      if (vm::BeginsSign(text_[end])) left.push_back({next, end, place.tags});
    }
  }

  /// False if they are more than kMaxMeaningBytes.
  bool Read(const Tags* last, std::vector<std::string>& tags, std::size_t& bytes) const {
    std::vector<const Tags*> list;
    for (; last != nullptr; last = last->before) list.push_back(last);
    for (auto one = list.rbegin(); one != list.rend(); ++one) {
      if ((*one)->text == nullptr) {
        if (!Read((*one)->inside, tags, bytes)) return false;
        continue;
      }
      bytes += (*one)->text->size() + 1;
      if (bytes > kMaxMeaningBytes) return false;
      tags.push_back(*(*one)->text);
    }
    return true;
  }

  const Network& network_;
  std::string text_;  // the words without blanks
  std::vector<std::size_t> starts_;
  std::map<std::pair<Id, std::size_t>, std::vector<Way>> ways_;
  std::deque<Tags> tags_;
  std::size_t steps_ = 0;
  int nesting_ = 0;
};

std::optional<std::vector<std::string>> Network::Match(
    const std::vector<std::string>& words) const {
  if (words.empty()) return std::nullopt;
  return Walk(*this, words).Run();
}

}  // namespace ear
