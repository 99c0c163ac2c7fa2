#include "task_manager/grammar/ends_finder.h"

#include <algorithm>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/text.h"

namespace vxml::srgs {
namespace {

using Kind = Expansion::Kind;

const Ends kNone;

void Merge(Ends& into, const Ends& from) {
  for (const std::size_t end : from) InsertEnd(into, end);
}

}  // namespace

void InsertEnd(Ends& ends, std::size_t end) {
  const auto at = std::lower_bound(ends.begin(), ends.end(), end);
  if (at == ends.end() || *at != end) ends.insert(at, end);
}
bool Holds(const Ends& ends, std::size_t end) {
  return std::binary_search(ends.begin(), ends.end(), end);
}

EndsFinder::EndsFinder(const std::string& input, bool dtmf, bool split_digits)
    : text_(dtmf ? FoldKeys(Fold(input)) : Fold(input)), dtmf_(dtmf), split_digits_(split_digits) {}

bool EndsFinder::Spend() {
  if (++steps_ > kMaxSteps || depth_ > kMaxDepth) over_limit_ = true;
  return !over_limit_;
}

const Ends& EndsFinder::OfNode(const Expansion& node, std::size_t at) {
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
const Ends& EndsFinder::OfRule(const Rule& rule, std::size_t at) {
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
    Ends ends = OfNode(*rule.expansion, at);
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

Ends EndsFinder::Compute(const Expansion& node, std::size_t at) {
  switch (node.kind) {
    case Kind::kToken:
      return OfToken(node, at);
    case Kind::kTag:
    case Kind::kNull:
      return {at};
    case Kind::kVoid:
      return {};
    case Kind::kGarbage:
      return OfGarbage(at);
    case Kind::kReference:
      return node.target ? OfRule(*node.target, at) : Ends{};
    case Kind::kAlternatives: {
      Ends ends;
      for (const auto& child : node.children) Merge(ends, OfNode(*child, at));
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
      for (std::size_t turns = static_cast<std::size_t>(node.min); turns < layers.size(); ++turns) {
        Merge(ends, layers[turns]);
      }
      return ends;
    }
  }
  return {};
}

Ends EndsFinder::Step(const Expansion& child, const Ends& from) {
  Ends to;
  for (const std::size_t at : from) Merge(to, OfNode(child, at));
  return to;
}

std::vector<Ends> EndsFinder::Layers(const Expansion& node, std::size_t at) {
  std::vector<Ends> layers{{at}};
  while (node.max == Expansion::kUnbounded || static_cast<int>(layers.size()) <= node.max) {
    const int turn = static_cast<int>(layers.size());
    Ends next;
    for (const std::size_t from : layers.back()) {
      for (const std::size_t end : OfNode(*node.children[0], from)) {
        if (end > from || turn <= node.min) InsertEnd(next, end);
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

namespace {

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || c == '\''; }

}  // namespace

bool EndsFinder::AtWordEnd(std::size_t at) const {
  if (dtmf_ || at == text_.size() || text_[at] == ' ') return true;
  if (split_digits_ && (!IsLetter(text_[at - 1]) || !IsLetter(text_[at]))) return true;
  return IsUnspaced(DecodeBefore(text_, at)) || IsUnspaced(vm::SignAt(text_, at).value);
}
std::size_t EndsFinder::SkipBlank(std::size_t at) const {
  return at < text_.size() && text_[at] == ' ' ? at + 1 : at;
}

Ends EndsFinder::OfToken(const Expansion& node, std::size_t at) {
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

Ends EndsFinder::OfGarbage(std::size_t at) {
  touched_end_ = true;
  Ends ends{at};
  for (std::size_t end = at; end < text_.size();) {
    end += vm::SignAt(text_, end).length;
    if (AtWordEnd(end) && text_[end - 1] != ' ') ends.push_back(end);
  }
  return ends;
}

}  // namespace vxml::srgs
