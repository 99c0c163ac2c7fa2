#include "task_manager/grammar/matcher.h"

#include <functional>
#include <optional>
#include <unordered_set>
#include <utility>

#include "task_manager/grammar/chart.h"

namespace vxml::srgs {

using Kind = Expansion::Kind;

namespace {

/// The part of the input, in places, that an expansion takes.
struct Span {
  std::size_t begin;
  std::size_t end;
  bool operator==(const Span&) const = default;
};

/// May this expansion take the whole of the span at hand? Asked of parts, whose parse must not need
/// the parse that it is a part of.
using MayTakeAll = std::function<bool(const Expansion&)>;

/// Reads one parse off the chart.
class ParseReader {
 public:
  explicit ParseReader(Chart& chart) : chart_(chart) {}

  std::unique_ptr<Parse> Read(const Rule& root) {
    auto parse = OfRule(root, {0, chart_.last()});
    if (!met_itself_) return parse;
    careful_ = true;
    return OfRule(root, {0, chart_.last()});
  }
  bool too_deep() const { return too_deep_; }

 private:
  struct OpenRule {
    const Rule* rule;
    Span span;
    bool operator==(const OpenRule&) const = default;
  };
  /// The places reached behind 0, 1, 2 ... parts.
  using Reached = std::vector<Places>;

  std::unique_ptr<Parse> OfRule(const Rule& rule, const Span& span) {
    auto parse = std::make_unique<Parse>();
    parse->rule = &rule;
    parse->name = rule.name;
    parse->begin = chart_.ByteOf(span.begin);
    parse->end = chart_.ByteOf(span.end);
    if (IsOpen(rule, span)) {
      met_itself_ = true;
      return parse;
    }
    open_.push_back({&rule, span});
    if (rule.expansion) Add(*rule.expansion, span, *parse);
    open_.pop_back();
    return parse;
  }

  bool IsOpen(const Rule& rule, const Span& span) const {
    for (auto open = open_.rbegin(); open != open_.rend() && open->span == span; ++open) {
      if (open->rule == &rule) return true;
    }
    return false;
  }

  void Add(const Expansion& node, const Span& span, Parse& into) {
    if (met_itself_ && !careful_) return;
    too_deep_ = too_deep_ || depth_ > kMaxParseDepth;
    if (too_deep_ || !chart_.Spend(1)) return;
    ++depth_;
    switch (node.kind) {
      case Kind::kToken:
        into.items.push_back({ParseItem::Kind::kToken, node.text, nullptr});
        break;
      case Kind::kTag:
        into.items.push_back({ParseItem::Kind::kTag, node.text, nullptr});
        break;
      case Kind::kGarbage:
        if (span.end > span.begin) {
          into.items.push_back(
              {ParseItem::Kind::kGarbage, chart_.Words(span.begin, span.end), nullptr});
        }
        break;
      case Kind::kReference:
        into.items.push_back({ParseItem::Kind::kRule, "", OfRule(*node.target, span)});
        break;
      case Kind::kAlternatives:
        AddBest(node, span, into);
        break;
      case Kind::kSequence: {
        const auto may = WholeTaker(span);
        const auto part = [&](std::size_t i) -> const Expansion& { return *node.children[i]; };
        AddChain(part, ReachedByParts(node, span, may), node.children.size(), span, may, into);
        break;
      }
      case Kind::kRepeat:
        AddTurns(node, span, into);
        break;
      case Kind::kNull:
      case Kind::kVoid:
        break;
    }
    --depth_;
  }

  void AddBest(const Expansion& node, const Span& span, Parse& into) {
    const auto may = WholeTaker(span);
    const Expansion* best = nullptr;
    double best_weight = -1;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const double weight = i < node.weights.size() ? node.weights[i] : 1;
      const Expansion& child = *node.children[i];
      if (weight > best_weight && chart_.Ends(child, span.begin).test(span.end) && may(child)) {
        best = &child;
        best_weight = weight;
      }
    }
    if (best) Add(*best, span, into);
  }

  void AddTurns(const Expansion& node, const Span& span, Parse& into) {
    const auto may = WholeTaker(span);
    const Expansion& turn = *node.children[0];
    const Reached reached = ReachedByTurns(node, span, may);
    const auto turns = Turns(node, reached, span, may);
    if (!turns) return;
    const auto part = [&](std::size_t) -> const Expansion& { return turn; };
    AddChain(part, reached, *turns, span, may, into);
    for (std::size_t i = *turns; i < static_cast<std::size_t>(node.min); ++i) {
      Add(turn, {span.end, span.end}, into);
    }
  }

  /// `parts` parts one after the other over the span, each as long as the rest allows.
  void AddChain(const std::function<const Expansion&(std::size_t)>& part, const Reached& reached,
                std::size_t parts, const Span& span, const MayTakeAll& may, Parse& into) {
    if (chart_.over_limit()) return;
    Reached useful(parts + 1, Places(chart_.size()));
    useful[parts].set(span.end);
    for (std::size_t i = parts; i-- > 0;) {
      for (std::size_t at = reached[i].find_first(); at != Places::npos;
           at = reached[i].find_next(at)) {
        if (EndsOf(part(i), at, span, may).intersects(useful[i + 1])) useful[i].set(at);
      }
    }
    std::size_t at = span.begin;
    for (std::size_t i = 0; i < parts && !chart_.over_limit(); ++i) {
      const Places ends = EndsOf(part(i), at, span, may) & useful[i + 1];
      std::size_t next = at;
      for (std::size_t end = ends.find_first(); end != Places::npos; end = ends.find_next(end)) {
        next = end;
      }
      Add(part(i), {at, next}, into);
      at = next;
    }
  }

  Places EndsOf(const Expansion& node, std::size_t at, const Span& span, const MayTakeAll& may) {
    Places ends = chart_.Ends(node, at);
    chart_.Spend(1 + ends.num_blocks());
    if (at == span.begin && ends.test(span.end) && !may(node)) ends.reset(span.end);
    return ends;
  }

  Places Behind(const Expansion& part, const Places& from, const Span& span, const MayTakeAll& may,
                bool takes_something) {
    Places to(chart_.size());
    for (std::size_t at = from.find_first(); at != Places::npos && at <= span.end;
         at = from.find_next(at)) {
      Places ends = EndsOf(part, at, span, may);
      if (takes_something) ends.reset(at);
      to |= ends;
    }
    return to;
  }

  Reached ReachedByParts(const Expansion& node, const Span& span, const MayTakeAll& may) {
    Reached reached{Places(chart_.size())};
    reached[0].set(span.begin);
    for (const auto& child : node.children) {
      reached.push_back(Behind(*child, reached.back(), span, may, false));
    }
    return reached;
  }

  /// Of turns that take something.
  Reached ReachedByTurns(const Expansion& node, const Span& span, const MayTakeAll& may) {
    Reached reached{Places(chart_.size())};
    reached[0].set(span.begin);
    const bool endless = node.max == Expansion::kUnbounded;
    while (endless || reached.size() <= static_cast<std::size_t>(node.max)) {
      Places next = Behind(*node.children[0], reached.back(), span, may, true);
      if (next.none() || chart_.over_limit()) break;
      reached.push_back(std::move(next));
    }
    return reached;
  }

  /// The most turns that end where the span does; those missing to the least must be able to take
  /// nothing there.
  std::optional<std::size_t> Turns(const Expansion& node, const Reached& reached, const Span& span,
                                   const MayTakeAll& may) {
    for (std::size_t turns = reached.size(); turns-- > 0;) {
      if (!reached[turns].test(span.end)) continue;
      if (turns >= static_cast<std::size_t>(node.min)) return turns;
      const Expansion& turn = *node.children[0];
      const bool empty =
          chart_.Ends(turn, span.end).test(span.end) && (span.begin != span.end || may(turn));
      if (empty) return turns;
    }
    return {};
  }

  /// Without cycles the chart is right by itself. Where a parse met itself, what may take the span
  /// is found anew without the rules that are being read over this very span.
  MayTakeAll WholeTaker(const Span& span) {
    if (!careful_) return [](const Expansion&) { return true; };
    return [this, span](const Expansion& node) {
      std::unordered_set<const Expansion*> proven;
      while (true) {
        const std::size_t before = proven.size();
        std::unordered_set<const Expansion*> seen;
        if (Proves(node, span, proven, seen)) return true;
        if (proven.size() == before || chart_.over_limit()) return false;
      }
    };
  }

  /// One round of proof: what is met a second time in a round counts as unproven.
  bool Proves(const Expansion& node, const Span& span, std::unordered_set<const Expansion*>& proven,
              std::unordered_set<const Expansion*>& seen) {
    if (proven.contains(&node)) return true;
    if (!chart_.Ends(node, span.begin).test(span.end)) return false;
    if (!seen.insert(&node).second || !chart_.Spend(1)) return false;
    const MayTakeAll may = [&](const Expansion& part) { return Proves(part, span, proven, seen); };
    bool holds = true;
    if (node.kind == Kind::kReference) {
      holds = !IsOpen(*node.target, span) && may(*node.target->expansion);
    } else if (node.kind == Kind::kAlternatives) {
      holds = false;
      for (const auto& child : node.children) holds = holds || may(*child);
    } else if (node.kind == Kind::kSequence) {
      holds = ReachedByParts(node, span, may).back().test(span.end);
    } else if (node.kind == Kind::kRepeat) {
      holds = Turns(node, ReachedByTurns(node, span, may), span, may).has_value();
    }
    if (holds) proven.insert(&node);
    return holds;
  }

  Chart& chart_;
  std::vector<OpenRule> open_;  ///< outermost first
  bool met_itself_ = false;     ///< a rule needed its own parse over the same span
  bool careful_ = false;
  bool too_deep_ = false;
  int depth_ = 0;
};

}  // namespace

MatchResult Match(const Rule& root, const std::string& input) {
  MatchResult result;
  const bool dtmf = root.grammar && root.grammar->mode == Mode::kDtmf;
  Chart chart(input, dtmf, root.grammar && root.grammar->split_digits);
  if (chart.text().size() > kMaxInputBytes) {
    result.over_limit = true;
    return result;
  }
  const bool matches = root.expansion && chart.Ends(*root.expansion, 0).test(chart.last());
  result.can_continue = chart.touched_end();
  if (matches && !chart.over_limit()) {
    ParseReader reader(chart);
    result.parse = reader.Read(root);
    result.over_limit = reader.too_deep();
  }
  result.over_limit = result.over_limit || chart.over_limit();
  if (result.over_limit) result.parse = nullptr;
  return result;
}

}  // namespace vxml::srgs
