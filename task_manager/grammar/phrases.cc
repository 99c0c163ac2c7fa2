#include "task_manager/grammar/phrases.h"

#include <algorithm>
#include <vector>

namespace vxml::srgs {

using Kind = Expansion::Kind;

namespace {

class Writer {
 public:
  explicit Writer(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  std::optional<std::string> Of(const Rule& rule) {
    if (!rule.expansion || open_.size() > 30) return {};
    if (std::find(open_.begin(), open_.end(), &rule) != open_.end()) return {};
    open_.push_back(&rule);
    auto text = Of(*rule.expansion);
    open_.pop_back();
    return text;
  }

 private:
  using Text = std::optional<std::string>;

  Text Of(const Expansion& node) {
    switch (node.kind) {
      case Kind::kToken:
        if (node.folded.find_first_of("[](){}<>|*+$/#=;\"") != std::string::npos) return {};
        return node.folded;
      case Kind::kTag:
      case Kind::kNull:
        return "";
      case Kind::kVoid:
        return {};
      case Kind::kGarbage:
        return "[*]";
      case Kind::kReference:
        return node.target ? Of(*node.target) : Text{};
      case Kind::kSequence: {
        std::string all;
        for (const auto& child : node.children) {
          const Text part = Of(*child);
          if (!part || !Join(all, *part)) return {};
        }
        return all;
      }
      case Kind::kAlternatives:
        return Choice(node);
      case Kind::kRepeat:
        return Repeat(node);
    }
    return {};
  }

  bool Join(std::string& all, const std::string& part) const {
    if (!all.empty() && !part.empty()) all += ' ';
    all += part;
    return all.size() <= most_bytes_;
  }

  /// What can never be said is left out; an empty alternative makes the choice optional.
  Text Choice(const Expansion& node) {
    std::string all;
    bool empty = false;
    bool any = false;
    for (const auto& child : node.children) {
      if (child->kind == Kind::kVoid) continue;
      const Text part = Of(*child);
      if (!part) return {};
      any = true;
      empty = empty || part->empty();
      if (part->empty()) continue;
      all += (all.empty() ? "" : " | ") + *part;
      if (all.size() > most_bytes_) return {};
    }
    if (!any) return {};
    if (all.empty()) return "";
    return (empty ? "[(" : "(") + all + (empty ? ")]" : ")");
  }

  Text Optional(const std::string& part, int turns) const {
    std::string all;
    for (int i = 0; i < turns; ++i) {
      all = "[" + part + (all.empty() ? "" : " ") + all + "]";
      if (all.size() > most_bytes_) return {};
    }
    return all;
  }

  Text Repeat(const Expansion& node) {
    const Text part = Of(*node.children[0]);
    if (!part) return node.min == 0 ? Text("") : Text{};
    if (part->empty()) return "";
    const int most = node.max == Expansion::kUnbounded ? node.min + kMostTurns : node.max;
    std::string all;
    for (int i = 0; i < node.min; ++i) {
      if (!Join(all, *part)) return {};
    }
    const Text rest = Optional(*part, std::min(most - node.min, 3 * kMostTurns));
    if (!rest || !Join(all, *rest)) return {};
    return all;
  }

  std::size_t most_bytes_;
  std::vector<const Rule*> open_;
};

}  // namespace

std::optional<std::string> ToPhrases(const Rule& rule, std::size_t most_bytes) {
  auto text = Writer(most_bytes).Of(rule);
  if (!text || text->empty() || text->size() > most_bytes) return {};
  return text;
}

}  // namespace vxml::srgs
