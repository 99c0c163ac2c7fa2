#include "task_manager/grammar/matcher.h"

#include <algorithm>
#include <utility>

#include "task_manager/grammar/ends_finder.h"

namespace vxml::srgs {
namespace {

/// Reads one parse off the ends that were found.
class ParseReader {
 public:
  explicit ParseReader(EndsFinder& finder) : finder_(finder) {}

  std::unique_ptr<Parse> BuildRule(const Rule& rule, const std::string& name, std::size_t begin,
                                   std::size_t end) {
    auto parse = std::make_unique<Parse>();
    parse->rule = &rule;
    parse->name = name;
    parse->begin = begin;
    parse->end = end;
    const Place key{{&rule, begin}, end};
    if (std::find(building_.begin(), building_.end(), key) != building_.end()) return parse;
    building_.push_back(key);
    if (rule.expansion) Build(*rule.expansion, begin, end, *parse);
    building_.pop_back();
    return parse;
  }

 private:
  using Kind = Expansion::Kind;
  using Place = std::pair<std::pair<const Rule*, std::size_t>, std::size_t>;

  void Build(const Expansion& node, std::size_t at, std::size_t end, Parse& into) {
    if (!finder_.Spend()) return;
    finder_.Enter();
    switch (node.kind) {
      case Kind::kToken:
        into.items.push_back({ParseItem::Kind::kToken, node.text, nullptr});
        break;
      case Kind::kTag:
        into.items.push_back({ParseItem::Kind::kTag, node.text, nullptr});
        break;
      case Kind::kGarbage:
        if (end > at) {
          into.items.push_back(
              {ParseItem::Kind::kGarbage,
               finder_.text().substr(finder_.SkipBlank(at), end - finder_.SkipBlank(at)), nullptr});
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
    finder_.Leave();
  }

  void BuildAlternative(const Expansion& node, std::size_t at, std::size_t end, Parse& into) {
    const Expansion* best = nullptr;
    double best_weight = -1;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const double weight = i < node.weights.size() ? node.weights[i] : 1;
      if (weight > best_weight && Holds(finder_.OfNode(*node.children[i], at), end)) {
        best = node.children[i].get();
        best_weight = weight;
      }
    }
    if (best) Build(*best, at, end, into);
  }

  void BuildRepeat(const Expansion& node, std::size_t at, std::size_t end, Parse& into) {
    const std::vector<Ends> layers = finder_.Layers(node, at);
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
    for (const Expansion* part : parts) reached.push_back(finder_.Step(*part, reached.back()));
    std::vector<Ends> useful(parts.size() + 1);
    useful.back() = {end};
    for (std::size_t i = parts.size(); i-- > 0;) {
      for (const std::size_t from : reached[i]) {
        const Ends& ends = finder_.OfNode(*parts[i], from);
        if (std::any_of(ends.begin(), ends.end(),
                        [&](std::size_t e) { return Holds(useful[i + 1], e); })) {
          InsertEnd(useful[i], from);
        }
      }
    }
    for (std::size_t i = 0; i < parts.size() && !finder_.over_limit(); ++i) {
      const Ends ends = finder_.OfNode(*parts[i], at);
      std::size_t next = at;
      for (const std::size_t e : ends) {
        if (Holds(useful[i + 1], e)) next = e;
      }
      Build(*parts[i], at, next, into);
      at = next;
    }
  }

  EndsFinder& finder_;
  std::vector<Place> building_;
};

}  // namespace

MatchResult Match(const Rule& root, const std::string& input) {
  MatchResult result;
  const bool dtmf = root.grammar && root.grammar->mode == Mode::kDtmf;
  EndsFinder finder(input, dtmf, root.grammar && root.grammar->split_digits);
  const std::size_t end = finder.text().size();
  if (end > kMaxInputBytes) {
    result.over_limit = true;
    return result;
  }
  const bool matches = Holds(finder.OfRule(root, 0), end);
  result.can_continue = finder.touched_end();
  if (matches && !finder.over_limit()) {
    result.parse = ParseReader(finder).BuildRule(root, root.name, 0, end);
  }
  result.over_limit = finder.over_limit();
  if (result.over_limit) result.parse = nullptr;
  return result;
}

}  // namespace vxml::srgs
