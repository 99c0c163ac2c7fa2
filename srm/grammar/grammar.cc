#include "srm/grammar/grammar.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace srm {
namespace {

using Kind = Node::Kind;

std::string AtLine(std::size_t line) {
  return line == 0 ? std::string() : "line " + std::to_string(line) + ": ";
}

/// Looks over all the rules once and keeps the first thing that is wrong.
class Checker {
 public:
  Checker(const Grammar::Rules& rules, const std::string& root) : rules_(rules) {
    if (!rules.contains(root)) Wrong(vm::Errc::kBadValue, "there is no rule '" + root + "'");
    for (const auto& [name, node] : rules) Visit(node, 0);
    FindNullable();
    for (const auto& [name, node] : rules) {
      std::vector<std::string> path;
      FindLeftRecursion(name, path);
    }
  }
  vm::Result<void> Outcome() const {
    if (error_.text.empty()) return {};
    return std::unexpected(error_);
  }
  bool has_any() const { return has_any_; }

 private:
  void Wrong(vm::Errc code, std::string text) {
    if (error_.text.empty()) error_ = {code, std::move(text), 0};
  }

  void Visit(const Node& node, int depth) {
    if (depth > Grammar::kMaxDepth)
      return Wrong(vm::Errc::kLimit, AtLine(node.line) + "nested too deep");
    if (++nodes_ > Grammar::kMaxNodes) {
      return Wrong(vm::Errc::kLimit,
                   "the grammar has more than " + std::to_string(Grammar::kMaxNodes) + " parts");
    }
    if (node.kind == Kind::kAny) has_any_ = true;
    if (node.kind == Kind::kRule && !rules_.contains(node.text)) {
      Wrong(vm::Errc::kBadValue, AtLine(node.line) + "there is no rule '" + node.text + "'");
    }
    if (node.kind == Kind::kRepeat &&
        (node.least < 0 || node.least > Grammar::kMaxRepeat || node.most > Grammar::kMaxRepeat ||
         (node.most != kUnlimited && node.most < node.least))) {
      Wrong(vm::Errc::kBadValue, AtLine(node.line) + "repeats must be from 0 to " +
                                     std::to_string(Grammar::kMaxRepeat) + ", the lesser first");
    }
    for (const Node& part : node.parts) Visit(part, depth + 1);
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
  void Beginnings(const Node& node, std::set<std::string>& names) const {
    if (node.kind == Kind::kRule) names.insert(node.text);
    for (const Node& part : node.parts) {
      Beginnings(part, names);
      if (node.kind == Kind::kSequence && !Nullable(part)) break;
    }
  }

  void FindLeftRecursion(const std::string& name, std::vector<std::string>& path) {
    if (const auto seen = std::find(path.begin(), path.end(), name); seen != path.end()) {
      std::string round;
      for (auto it = seen; it != path.end(); ++it) round += *it + " -> ";
      const auto rule = rules_.find(name);
      return Wrong(vm::Errc::kBadValue, AtLine(rule->second.line) + "rule '" + name +
                                            "' begins with itself (" + round + name + ")");
    }
    const auto rule = rules_.find(name);
    if (rule == rules_.end() || !done_.insert(name).second) return;
    path.push_back(name);
    std::set<std::string> names;
    Beginnings(rule->second, names);
    for (const std::string& next : names) {
      if (std::find(path.begin(), path.end(), next) != path.end()) done_.erase(next);
      FindLeftRecursion(next, path);
    }
    path.pop_back();
  }

  const Grammar::Rules& rules_;
  std::set<std::string> nullable_, done_;
  std::size_t nodes_ = 0;
  bool has_any_ = false;
  vm::Error error_{};
};

/// Finds one way through the grammar, by trying the alternatives in order.
class Matcher {
 public:
  Matcher(const Grammar::Rules& rules, const std::vector<std::string>& words) : rules_(rules) {
    for (const std::string& word : words) {
      starts_.push_back(text_.size());
      text_ += word;
    }
    starts_.push_back(text_.size());
  }

  bool Run(const Node& root, std::vector<std::string>& tags) {
    const bool fits = Try(root, 0, [&](std::size_t at) { return at == text_.size(); });
    tags = std::move(tags_);
    return fits;
  }

 private:
  using Next = std::function<bool(std::size_t)>;
  static constexpr std::size_t kMaxSteps = 200'000;  // beyond this the text does not fit
  static constexpr int kMaxDepth = 4000;

  bool Boundary(std::size_t at) const {
    return std::binary_search(starts_.begin(), starts_.end(), at);
  }

  bool Try(const Node& node, std::size_t at, const Next& next) {
    if (++steps_ > kMaxSteps || depth_ > kMaxDepth) return false;
    ++depth_;
    const bool fits = TryKind(node, at, next);
    --depth_;
    return fits;
  }

  bool TryKind(const Node& node, std::size_t at, const Next& next) {
    switch (node.kind) {
      case Kind::kWord: {
        const std::size_t end = at + node.text.size();
        if (text_.compare(at, node.text.size(), node.text) != 0) return false;
        const bool ascii = static_cast<unsigned char>(node.text.back()) < 0x80;
        return (!ascii || Boundary(end)) && next(end);
      }
      case Kind::kAny: {
        const auto end = std::upper_bound(starts_.begin(), starts_.end(), at);
        return end != starts_.end() && next(*end);
      }
      case Kind::kTag: {
        tags_.push_back(node.text);
        if (next(at)) return true;
        tags_.pop_back();
        return false;
      }
      case Kind::kRule:
        return Try(rules_.find(node.text)->second, at, next);
      case Kind::kChoice:
        return std::any_of(node.parts.begin(), node.parts.end(),
                           [&](const Node& part) { return Try(part, at, next); });
      case Kind::kRepeat:
        return Repeat(node, 0, at, next);
      case Kind::kSequence:
        return Sequence(node, 0, at, next);
      case Kind::kVoid:
        return false;
    }
    return false;
  }

  bool Sequence(const Node& node, std::size_t index, std::size_t at, const Next& next) {
    if (index == node.parts.size()) return next(at);
    return Try(node.parts[index], at,
               [&, index](std::size_t then) { return Sequence(node, index + 1, then, next); });
  }

  bool Repeat(const Node& node, int count, std::size_t at, const Next& next) {
    const bool more = node.most == kUnlimited || count < node.most;
    if (more && Try(node.parts[0], at, [&, count, at](std::size_t then) {
          // A round without words would go on for ever.
          return (then > at || count < node.least) && Repeat(node, count + 1, then, next);
        })) {
      return true;
    }
    return count >= node.least && next(at);
  }

  const Grammar::Rules& rules_;
  std::string text_;
  std::vector<std::size_t> starts_;
  std::vector<std::string> tags_;
  std::size_t steps_ = 0;
  int depth_ = 0;
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
  grammar.rules_ = std::move(rules);
  grammar.root_ = std::move(root);
  grammar.has_any_ = checker.has_any();
  return grammar;
}

std::string Grammar::Meaning::Joined() const {
  std::string all;
  for (const std::string& tag : tags) all += (all.empty() ? "" : ";") + tag;
  return all;
}

std::optional<Grammar::Meaning> Grammar::Match(std::string_view text) const {
  const std::vector<std::string> words = WordsOf(text);
  if (words.empty()) return std::nullopt;
  Meaning meaning;
  if (!Matcher(rules_, words).Run(rules_.find(root_)->second, meaning.tags)) return std::nullopt;
  return meaning;
}

std::set<std::string> Grammar::Words() const {
  std::set<std::string> words;
  for (const auto& [name, node] : rules_) CollectWords(node, words);
  return words;
}

vm::Result<Grammar> ParseGrammar(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const std::string_view head = begin == std::string_view::npos ? "" : text.substr(begin);
  if (text.size() > Grammar::kMaxBytes) {
    return vm::Fail(vm::Errc::kTooLong, "the grammar has " + std::to_string(text.size()) +
                                            " bytes, expected at most " +
                                            std::to_string(Grammar::kMaxBytes));
  }
  if (head.starts_with("#JSGF")) return ParseJsgf(head);
  if (head.starts_with('<')) return ParseSrgs(head);
  return ParseOwnForm(text);
}

}  // namespace srm
