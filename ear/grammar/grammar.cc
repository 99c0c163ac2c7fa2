#include "ear/grammar/grammar.h"

#include <algorithm>
#include <utility>

#include "ear/grammar/expansion.h"
#include "ear/grammar/grammar_limits.h"
#include "ear/grammar/matcher.h"

namespace ear {
namespace {

using Kind = Node::Kind;

/// What a part costs when it is written out; a number beyond all limits is still a number.
struct Cost {
  double parts = 1;
  double bytes = 0;
  double nesting = 0;  ///< of rules

  void Add(const Cost& part) {
    parts += part.parts;
    bytes += part.bytes;
    nesting = std::max(nesting, part.nesting);
  }
};

/// Looks over all the rules once and keeps the first thing that is wrong.
class Checker {
 public:
  Checker(const Grammar::Rules& rules, const std::string& root) : rules_(rules) {
    if (!rules.contains(root)) Wrong(vm::Errc::kBadValue, "there is no rule '" + root + "'");
    for (const auto& [name, node] : rules) Visit(name, node, 0);
    for (auto rule = rules.begin(); good() && rule != rules.end(); ++rule) OfRule(rule->first);
    if (good() && recursive_) {
      // What was kept depends on where the recursion was entered; an engine does not keep it.
      keep_costs_ = false;
      costs_.clear();
      expanded_ = OfRule(root);
    } else if (good()) {
      expanded_ = costs_.at(root);
    }
    if (!good()) return;
    FindNullable();
    for (const auto& [name, node] : rules) FindLeftRecursion(name);
  }
  vm::Result<void> Outcome() const {
    if (good()) return {};
    return std::unexpected(error_);
  }
  bool has_any() const { return has_any_; }
  std::size_t expanded_parts() const { return static_cast<std::size_t>(expanded_.parts); }

 private:
  bool good() const { return error_.text.empty(); }
  void Wrong(vm::Errc code, std::string text) {
    if (good()) error_ = {code, std::move(text), 0};
  }
  void TooMuch(std::string_view rule, std::size_t line, const std::string& what) {
    Wrong(vm::Errc::kLimit, AtLine(line) + RuleLabel(rule) + ": " + what);
  }

  void Visit(std::string_view rule, const Node& node, int depth) {
    if (depth > kMaxNesting) return TooMuch(rule, node.line, NestedTooDeep());
    if (++nodes_ > kMaxParts) return TooMuch(rule, node.line, TooManyParts());
    if (node.kind == Kind::kAny) has_any_ = true;
    if (node.kind == Kind::kWord && node.text.size() > kMaxWordBytes) {
      return TooMuch(rule, node.line,
                     "a word of " + std::to_string(node.text.size()) + " bytes, expected at most " +
                         std::to_string(kMaxWordBytes));
    }
    if (node.kind == Kind::kRule && !rules_.contains(node.text)) {
      Wrong(vm::Errc::kBadValue, AtLine(node.line) + "there is no rule '" + node.text + "'");
    }
    if (node.kind == Kind::kRepeat &&
        (node.least < 0 || node.least > kMaxRepeat || node.most > kMaxRepeat ||
         (node.most != kUnlimited && node.most < node.least))) {
      Wrong(vm::Errc::kBadValue, AtLine(node.line) + "repeats must be from 0 to " +
                                     std::to_string(kMaxRepeat) + ", the lesser first");
    }
    for (const Node& part : node.parts) Visit(rule, part, depth + 1);
  }

  Cost Of(const Node& node) {
    Cost cost{.bytes = static_cast<double>(node.text.size())};
    if (node.kind == Kind::kRule) return OfRule(node.text);
    if (!keep_costs_ && ++visits_ > kMaxExpandedParts)
      TooManyExpanded(rules_.find(path_[0])->first);
    if (!good()) return cost;
    for (const Node& part : node.parts) cost.Add(Of(part));
    if (node.kind == Kind::kRepeat) {
      const int times = node.most == kUnlimited ? node.least + 1 : std::max(node.most, 1);
      cost.parts *= times;
      cost.bytes *= times;
    }
    return cost;
  }

  Cost OfRule(std::string_view name) {
    if (std::find(path_.begin(), path_.end(), name) != path_.end()) {
      recursive_ = true;
      return {};
    }
    if (const auto known = costs_.find(name); known != costs_.end()) return known->second;
    const auto rule = rules_.find(name);
    if (path_.size() > kMaxRuleNesting) RulesTooDeep(name);
    if (!good()) return {};
    path_.push_back(rule->first);
    Cost cost = Of(rule->second);
    path_.pop_back();
    if (++cost.nesting > static_cast<double>(kMaxRuleNesting)) RulesTooDeep(name);
    if (cost.parts > static_cast<double>(kMaxExpandedParts)) TooManyExpanded(name);
    if (cost.bytes > static_cast<double>(kMaxExpandedBytes)) {
      TooMuch(name, rule->second.line,
              "more than " + std::to_string(kMaxExpandedBytes) +
                  " bytes when its repeats and the rules in it are written out");
    }
    if (keep_costs_) costs_.emplace(rule->first, cost);
    return cost;
  }

  void RulesTooDeep(std::string_view name) {
    TooMuch(name, rules_.find(name)->second.line,
            "rules nested deeper than " + std::to_string(kMaxRuleNesting));
  }
  void TooManyExpanded(std::string_view name) {
    TooMuch(name, rules_.find(name)->second.line,
            "more than " + std::to_string(kMaxExpandedParts) +
                " parts when its repeats and the rules in it are written out");
  }

  bool Nullable(const Node& node) const {
    switch (node.kind) {
      case Kind::kWord:
      case Kind::kAny:
      case Kind::kVoid:
        return false;
      case Kind::kTag:
        return true;
      case Kind::kRule:
        return nullable_.contains(node.text);
      case Kind::kRepeat:
        return node.least == 0 || Nullable(node.parts[0]);
      case Kind::kChoice:
        return std::any_of(node.parts.begin(), node.parts.end(),
                           [this](const Node& part) { return Nullable(part); });
      case Kind::kSequence:
        return std::all_of(node.parts.begin(), node.parts.end(),
                           [this](const Node& part) { return Nullable(part); });
    }
    return false;
  }

  void FindNullable() {
    for (std::size_t before = SIZE_MAX; before != nullable_.size();) {
      before = nullable_.size();
      for (const auto& [name, node] : rules_) {
        if (Nullable(node)) nullable_.insert(name);
      }
    }
  }

  /// The rules with which a node may begin.
  void Beginnings(const Node& node, std::set<std::string_view>& names) const {
    if (node.kind == Kind::kRule) names.insert(node.text);
    for (const Node& part : node.parts) {
      Beginnings(part, names);
      if (node.kind == Kind::kSequence && !Nullable(part)) break;
    }
  }

  void FindLeftRecursion(std::string_view name) {
    const auto rule = rules_.find(name);
    if (const auto seen = std::find(path_.begin(), path_.end(), name); seen != path_.end()) {
      std::string round;
      for (auto it = seen; it != path_.end(); ++it) round += std::string(*it) + " -> ";
      return Wrong(vm::Errc::kBadValue, AtLine(rule->second.line) + "rule '" + std::string(name) +
                                            "' begins with itself (" + round + std::string(name) +
                                            ")");
    }
    if (!good() || !done_.insert(rule->first).second) return;
    if (path_.size() > kMaxRuleNesting) return RulesTooDeep(name);
    path_.push_back(rule->first);
    std::set<std::string_view> names;
    Beginnings(rule->second, names);
    for (const std::string_view next : names) FindLeftRecursion(next);
    path_.pop_back();
  }

  const Grammar::Rules& rules_;
  std::set<std::string_view> nullable_, done_;
  std::map<std::string_view, Cost> costs_;
  std::vector<std::string_view> path_;
  std::size_t nodes_ = 0, visits_ = 0;
  Cost expanded_{};
  bool keep_costs_ = true, recursive_ = false;
  bool has_any_ = false;
  vm::Error error_{};
};

void CollectWords(const Node& node, std::set<std::string>& words) {
  if (node.kind == Kind::kWord) words.insert(node.text);
  for (const Node& part : node.parts) CollectWords(part, words);
}

}  // namespace

vm::Result<Grammar> Grammar::Make(Rules rules, std::string root) {
  const Checker checker(rules, root);
  if (auto good = checker.Outcome(); !good) return std::unexpected(good.error());
  Grammar grammar;
  grammar.rules_ = std::make_shared<const Rules>(std::move(rules));
  grammar.network_ = std::make_shared<const Network>(*grammar.rules_, root);
  grammar.root_ = std::move(root);
  grammar.expanded_parts_ = checker.expanded_parts();
  grammar.has_any_ = checker.has_any();
  return grammar;
}

std::string Grammar::Meaning::Joined() const {
  std::string all;
  for (const std::string& tag : tags) all += (all.empty() ? "" : ";") + tag;
  return all;
}

std::optional<Grammar::Meaning> Grammar::Match(std::string_view text) const {
  return Match(WordsOf(text));
}

std::optional<Grammar::Meaning> Grammar::Match(const std::vector<std::string>& words) const {
  auto tags = network_->Match(words);
  if (!tags) return std::nullopt;
  return Meaning{std::move(*tags)};
}

std::set<std::string> Grammar::Words() const {
  std::set<std::string> words;
  for (const auto& [name, node] : *rules_) CollectWords(node, words);
  return words;
}

vm::Result<Grammar> ParseGrammar(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const std::string_view head = begin == std::string_view::npos ? "" : text.substr(begin);
  if (text.size() > kMaxGrammarBytes) {
    return vm::Fail(vm::Errc::kTooLong, "the grammar has " + std::to_string(text.size()) +
                                            " bytes, expected at most " +
                                            std::to_string(kMaxGrammarBytes));
  }
  if (head.starts_with("#JSGF")) return ParseJsgf(head);
  if (head.starts_with('<')) return ParseSrgs(head);
  return ParseOwnForm(text);
}

}  // namespace ear
