#include "task_manager/grammar/matcher.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "task_manager/grammar/text.h"

namespace vxml::srgs {
namespace {

using Ends = std::vector<std::size_t>;  // sorted, each once

void Insert(Ends& ends, std::size_t end) {
  const auto at = std::lower_bound(ends.begin(), ends.end(), end);
  if (at == ends.end() || *at != end) ends.insert(at, end);
}
void Merge(Ends& into, const Ends& from) {
  for (const std::size_t end : from) Insert(into, end);
}
bool Holds(const Ends& ends, std::size_t end) {
  return std::binary_search(ends.begin(), ends.end(), end);
}

struct Key {
  const void* node;
  std::size_t at;
  bool operator==(const Key&) const = default;
};
struct KeyHash {
  std::size_t operator()(const Key& key) const {
    return std::hash<const void*>()(key.node) * 1000003U + key.at;
  }
};

/// Finds where each expansion may end from each place (memoised), then reads one parse off that.
class Matcher {
 public:
  Matcher(const std::string& input, bool dtmf, bool split_digits)
      : text_(Fold(input)), dtmf_(dtmf), split_digits_(split_digits) {
    if (dtmf_) std::erase(text_, ' ');
  }

  MatchResult Run(const Rule& root) {
    MatchResult result;
    if (text_.size() > kMaxInputBytes) {
      result.over_limit = true;
      return result;
    }
    const Ends& ends = RuleEnds(root, 0);
    result.over_limit = over_limit_;
    result.can_continue = touched_end_;
    if (over_limit_) return result;
    std::size_t end = text_.size();
    if (!Holds(ends, end)) return result;
    result.parse = BuildRule(root, root.name, 0, end);
    result.over_limit = over_limit_;
    if (over_limit_) result.parse = nullptr;
    return result;
  }

 private:
  using Kind = Expansion::Kind;
  static constexpr int kMaxDepth = 4000;

  bool Spend() {
    if (++steps_ > kMaxSteps || depth_ > kMaxDepth) over_limit_ = true;
    return !over_limit_;
  }

  const Ends& NodeEnds(const Expansion& node, std::size_t at) {
    const Key key{&node, at};
    if (const auto found = memo_.find(key); found != memo_.end()) return found->second;
    if (!Spend()) return kNone;
    ++depth_;
    Ends ends = Compute(node, at);
    --depth_;
    log_.push_back(key);
    return memo_.insert_or_assign(key, std::move(ends)).first->second;
  }

  /// Rules may refer to themselves: the set is grown until it stays the same.
  const Ends& RuleEnds(const Rule& rule, std::size_t at) {
    const Key key{&rule, at};
    if (const auto found = memo_.find(key); found != memo_.end()) {
      if (const auto open = open_.find(key); open != open_.end()) open->second = true;
      return found->second;
    }
    if (!rule.expansion || !Spend()) return kNone;
    memo_[key] = {};
    open_.emplace(key, false);
    while (true) {
      const std::size_t mark = log_.size();
      open_[key] = false;
      Ends ends = NodeEnds(*rule.expansion, at);
      const bool recursive = open_[key];
      const bool grew = ends != memo_[key];
      memo_[key] = std::move(ends);
      if (!recursive || !grew || over_limit_) break;
      while (log_.size() > mark) {  // what was found on the way depended on the smaller set
        if (!open_.contains(log_.back())) memo_.erase(log_.back());
        log_.pop_back();
      }
    }
    open_.erase(key);
    log_.push_back(key);
    return memo_[key];
  }

  Ends Compute(const Expansion& node, std::size_t at) {
    switch (node.kind) {
      case Kind::kToken:
        return TokenEnds(node, at);
      case Kind::kTag:
      case Kind::kNull:
        return {at};
      case Kind::kVoid:
        return {};
      case Kind::kGarbage:
        return GarbageEnds(at);
      case Kind::kReference:
        return node.target ? RuleEnds(*node.target, at) : Ends{};
      case Kind::kAlternatives: {
        Ends ends;
        for (const auto& child : node.children) Merge(ends, NodeEnds(*child, at));
        return ends;
      }
      case Kind::kSequence: {
        Ends reached{at};
        for (const auto& child : node.children) reached = Step(*child, reached);
        return reached;
      }
      case Kind::kRepeat: {
        Ends ends;
        const std::vector<Ends> layers = Layers(node, at);
        for (std::size_t turns = static_cast<std::size_t>(node.min); turns < layers.size();
             ++turns) {
          Merge(ends, layers[turns]);
        }
        return ends;
      }
    }
    return {};
  }

  Ends Step(const Expansion& child, const Ends& from) {
    Ends to;
    for (const std::size_t at : from) Merge(to, NodeEnds(child, at));
    return to;
  }

  /// Places reached after 0, 1, 2 ... turns. Turns beyond `min` must take something.
  std::vector<Ends> Layers(const Expansion& node, std::size_t at) {
    std::vector<Ends> layers{{at}};
    while (node.max == Expansion::kUnbounded || static_cast<int>(layers.size()) <= node.max) {
      const int turn = static_cast<int>(layers.size());
      Ends next;
      for (const std::size_t from : layers.back()) {
        for (const std::size_t end : NodeEnds(*node.children[0], from)) {
          if (end > from || turn <= node.min) Insert(next, end);
        }
      }
      if (next.empty() || over_limit_ || !Spend()) break;
      // A long minimum of turns that take nothing ends at once.
      if (turn > static_cast<int>(text_.size()) + 1 && turn <= node.min && next == layers.back()) {
        layers.resize(static_cast<std::size_t>(node.min), next);
      }
      layers.push_back(std::move(next));
    }
    return layers;
  }

  static bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || c == '\''; }

  bool AtWordEnd(std::size_t at) const {
    if (dtmf_ || at == text_.size() || text_[at] == ' ') return true;
    if (split_digits_ && (!IsLetter(text_[at - 1]) || !IsLetter(text_[at]))) return true;
    std::size_t size = 0;
    return IsUnspaced(DecodeBefore(text_, at)) || IsUnspaced(DecodeAt(text_, at, size));
  }
  std::size_t SkipBlank(std::size_t at) const {
    return at < text_.size() && text_[at] == ' ' ? at + 1 : at;
  }

  Ends TokenEnds(const Expansion& node, std::size_t at) {
    if (node.folded.empty()) return {at};
    const std::size_t from = SkipBlank(at);
    const std::string_view rest = std::string_view(text_).substr(from);
    if (rest.size() < node.folded.size()) {
      if (std::string_view(node.folded).starts_with(rest)) touched_end_ = true;
      return {};
    }
    if (!rest.starts_with(node.folded)) return {};
    const std::size_t end = from + node.folded.size();
    if (!AtWordEnd(end)) return {};
    return {end};
  }

  Ends GarbageEnds(std::size_t at) {
    touched_end_ = true;
    Ends ends{at};
    for (std::size_t end = at; end < text_.size();) {
      std::size_t size = 1;
      DecodeAt(text_, end, size);
      end += size;
      if (AtWordEnd(end) && text_[end - 1] != ' ') ends.push_back(end);
    }
    return ends;
  }

  // --- reading one parse

  std::unique_ptr<Parse> BuildRule(const Rule& rule, const std::string& name, std::size_t begin,
                                   std::size_t end) {
    auto parse = std::make_unique<Parse>();
    parse->rule = &rule;
    parse->name = name;
    parse->begin = begin;
    parse->end = end;
    const std::pair<Key, std::size_t> key{{&rule, begin}, end};
    if (std::find(building_.begin(), building_.end(), key) != building_.end()) return parse;
    building_.push_back(key);
    if (rule.expansion) Build(*rule.expansion, begin, end, *parse);
    building_.pop_back();
    return parse;
  }

  void Build(const Expansion& node, std::size_t at, std::size_t end, Parse& into) {
    if (!Spend()) return;
    ++depth_;
    switch (node.kind) {
      case Kind::kToken:
        into.items.push_back({ParseItem::Kind::kToken, node.text, nullptr});
        break;
      case Kind::kTag:
        into.items.push_back({ParseItem::Kind::kTag, node.text, nullptr});
        break;
      case Kind::kGarbage:
        if (end > at) {
          into.items.push_back({ParseItem::Kind::kGarbage,
                                text_.substr(SkipBlank(at), end - SkipBlank(at)), nullptr});
        }
        break;
      case Kind::kReference:
        into.items.push_back(
            {ParseItem::Kind::kRule, "", BuildRule(*node.target, node.target->name, at, end)});
        break;
      case Kind::kAlternatives:
        BuildAlternative(node, at, end, into);
        break;
      case Kind::kSequence: {
        std::vector<const Expansion*> parts;
        for (const auto& child : node.children) parts.push_back(child.get());
        BuildChain(parts, at, end, into);
        break;
      }
      case Kind::kRepeat:
        BuildRepeat(node, at, end, into);
        break;
      case Kind::kNull:
      case Kind::kVoid:
        break;
    }
    --depth_;
  }

  void BuildAlternative(const Expansion& node, std::size_t at, std::size_t end, Parse& into) {
    const Expansion* best = nullptr;
    double best_weight = -1;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const double weight = i < node.weights.size() ? node.weights[i] : 1;
      if (weight > best_weight && Holds(NodeEnds(*node.children[i], at), end)) {
        best = node.children[i].get();
        best_weight = weight;
      }
    }
    if (best) Build(*best, at, end, into);
  }

  void BuildRepeat(const Expansion& node, std::size_t at, std::size_t end, Parse& into) {
    const std::vector<Ends> layers = Layers(node, at);
    for (std::size_t turns = layers.size(); turns-- > 0;) {
      if (static_cast<int>(turns) < node.min || !Holds(layers[turns], end)) continue;
      return BuildChain(std::vector<const Expansion*>(turns, node.children[0].get()), at, end,
                        into);
    }
  }

  /// Parts one after the other from `at` to `end`, each as long as the rest allows.
  void BuildChain(const std::vector<const Expansion*>& parts, std::size_t at, std::size_t end,
                  Parse& into) {
    std::vector<Ends> reached{{at}};
    for (const Expansion* part : parts) reached.push_back(Step(*part, reached.back()));
    std::vector<Ends> useful(parts.size() + 1);
    useful.back() = {end};
    for (std::size_t i = parts.size(); i-- > 0;) {
      for (const std::size_t from : reached[i]) {
        const Ends& ends = NodeEnds(*parts[i], from);
        if (std::any_of(ends.begin(), ends.end(),
                        [&](std::size_t e) { return Holds(useful[i + 1], e); })) {
          Insert(useful[i], from);
        }
      }
    }
    for (std::size_t i = 0; i < parts.size() && !over_limit_; ++i) {
      const Ends ends = NodeEnds(*parts[i], at);
      std::size_t next = at;
      for (const std::size_t e : ends) {
        if (Holds(useful[i + 1], e)) next = e;
      }
      Build(*parts[i], at, next, into);
      at = next;
    }
  }

  static inline const Ends kNone{};
  std::string text_;
  bool dtmf_;
  bool split_digits_;
  std::unordered_map<Key, Ends, KeyHash> memo_;
  std::unordered_map<Key, bool, KeyHash> open_;  // rules being computed; true = met again
  std::vector<Key> log_;
  std::vector<std::pair<Key, std::size_t>> building_;
  std::size_t steps_ = 0;
  int depth_ = 0;
  bool touched_end_ = false;
  bool over_limit_ = false;
};

std::string Quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

std::string Parse::Text() const {
  std::string text;
  const bool dtmf = rule && rule->grammar && rule->grammar->mode == Mode::kDtmf;
  for (const ParseItem& item : items) {
    const std::string part = item.kind == ParseItem::Kind::kRule  ? item.rule->Text()
                             : item.kind == ParseItem::Kind::kTag ? ""
                                                                  : item.text;
    if (part.empty()) continue;
    const bool joined = !dtmf && !text.empty() && [&] {
      std::size_t size = 0;
      return !IsUnspaced(DecodeBefore(text, text.size())) || !IsUnspaced(DecodeAt(part, 0, size));
    }();
    if (joined) text += ' ';
    text += part;
  }
  return text;
}

std::string Parse::Format() const {
  std::string out = "$" + name + "[";
  bool first = true;
  for (const ParseItem& item : items) {
    if (!std::exchange(first, false)) out += ", ";
    switch (item.kind) {
      case ParseItem::Kind::kToken:
        out += Quote(item.text);
        break;
      case ParseItem::Kind::kTag:
        out += "{" + item.text + "}";
        break;
      case ParseItem::Kind::kRule:
        out += item.rule->Format();
        break;
      case ParseItem::Kind::kGarbage:
        out += "$GARBAGE[" + Quote(item.text) + "]";
        break;
    }
  }
  return out + "]";
}

MatchResult Match(const Rule& root, const std::string& input) {
  const bool dtmf = root.grammar && root.grammar->mode == Mode::kDtmf;
  return Matcher(input, dtmf, root.grammar && root.grammar->split_digits).Run(root);
}

}  // namespace vxml::srgs
