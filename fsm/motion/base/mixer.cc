#include "fsm/motion/base/mixer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <span>

#include "fsm/base/table_reader.h"

namespace fsm {

// ---- the table

class Mixer::Reader {
 public:
  Mixer Read(const Table& table) {
    for (const TableRow& row : table.rows()) ReadRow(row);
    for (std::size_t i = 0; i < kWholeTargets; ++i) {
      if (seen_[i]) continue;
      table.Refuse(fmt::format("no row says how channel '{}' is mixed", kTargetNames[i]));
    }
    return std::move(out_);
  }

 private:
  void ReadRow(const TableRow& row) {
    const std::string& kind = row.key();
    const std::size_t count = row.size();
    if (kind == "channel" && (count == 3 || count == 5)) return ReadTarget(row);
    if (kind == "weight" && count == 5) return ReadWeight(row);
    if (kind == "steady" && (count == 3 || count == 4)) return ReadSteady(row);
    if (kind == "layer" && count == 2) return ReadLayer(row);
    if (kind == "signal" && count == 2) {
      signals_.insert(row.Name(1, "a name"));
      return;
    }
    row.Refuse(
        fmt::format("'{}' found; channel NAME sum|greatest [LOWEST HIGHEST], layer NAME, "
                    "signal NAME, weight LAYER CHANNEL SIGNAL FACTOR or steady LAYER LIMIT "
                    "[SIGNAL] expected",
                    fmt::join(row.words(), " ")));
  }

  void ReadTarget(const TableRow& row) {
    const auto found = std::ranges::find(kTargetNames, row.Word(1));
    const auto index = static_cast<std::size_t>(found - kTargetNames.begin());
    const std::string& how = row.Word(2);
    if (index >= kWholeTargets || (how != "sum" && how != "greatest")) {
      row.Refuse(
          fmt::format("'{} {}' found; {} with sum or greatest expected", row.Word(1), how,
                      fmt::join(kTargetNames.begin(), kTargetNames.begin() + kWholeTargets, ", ")));
    }
    TargetRule& target = out_.targets_[index];
    target = {.greatest = how == "greatest"};
    seen_[index] = true;
    if (row.size() == 3) return;
    target.min = row.Within(3, -1000, 1000, "the lowest value");
    target.max = row.Within(4, target.min, 1000, "the highest value");
  }

  Rules* FindLayer(std::string_view name) {
    const auto found = std::ranges::find(out_.layers_, name, &std::pair<std::string, Rules>::first);
    return found == out_.layers_.end() ? nullptr : &found->second;
  }

  Rules& LayerAt(const TableRow& row) {
    Rules* const layer = FindLayer(row.Word(1));
    if (layer == nullptr) row.Refuse(fmt::format("'{}' is no layer of a row above", row.Word(1)));
    return *layer;
  }

  const std::string& SignalAt(const TableRow& row, std::size_t word) {
    if (!signals_.contains(row.Word(word))) {
      row.Refuse(fmt::format("'{}' is no signal of a row above", row.Word(word)));
    }
    return row.Word(word);
  }

  void ReadLayer(const TableRow& row) {
    const std::string& name = row.Name(1, "a name");
    if (FindLayer(name) != nullptr || name == "result") {
      row.Refuse("the layer '" + name + "' is here twice");
    }
    out_.layers_.emplace_back(name, Rules{});
  }

  void ReadWeight(const TableRow& row) {
    Rules& layer = row.Word(1) == "result" ? out_.result_ : LayerAt(row);
    const auto found = std::ranges::find(kTargetNames, row.Word(2));
    if (found == kTargetNames.end()) {
      row.Refuse(
          fmt::format("'{}' found; {} expected", row.Word(2), fmt::join(kTargetNames, ", ")));
    }
    layer.weights.push_back({static_cast<Target>(found - kTargetNames.begin()), SignalAt(row, 3),
                             row.Within<double>(4, 0, 10, "a factor")});
  }

  void ReadSteady(const TableRow& row) {
    Rules& layer = LayerAt(row);
    layer.steady = Steady{row.Within(2, 0, 180, "a limit in degrees"),
                          row.size() == 4 ? SignalAt(row, 3) : ""};
  }

  Mixer out_;
  std::array<bool, kWholeTargets> seen_{};
  std::set<std::string> signals_;
};

vm::Result<Mixer> Mixer::Read(const std::string& name, std::string_view text) {
  return ReadTable(name, text, [](const Table& table) { return Reader().Read(table); });
}

// ---- mixing

const Mixer::Rules& Mixer::RulesOf(std::string_view layer) const {
  static const Rules kNoRules;
  for (const auto& [name, rules] : layers_) {
    if (name == layer) return rules;
  }
  return kNoRules;
}

Mixer::Factors Mixer::FactorsOf(const Rules& rules, const MotionLayers& layers) {
  Factors factors;
  factors.fill(1);
  for (const WeightRule& rule : rules.weights) {
    factors[rule.target] *= 1 - (1 - rule.factor) * layers.Signal(rule.signal);
  }
  return factors;
}

double Mixer::UnitFactor(const Factors& factors, const UnitRegions& regions, std::size_t unit) {
  constexpr std::array<Target, kRegions> kTargetOf = {kEyeUnits, kBrowUnits, kMouthUnits};
  const Target target = kTargetOf[static_cast<std::size_t>(regions.RegionOf(unit))];
  return FactorOf(factors, target) * (regions.Opens(unit) ? factors[kOpeningUnits] : 1);
}

template <typename To, typename Look, typename Visit>
void Mixer::ForEachValue(To& to, Look& look, const MotionLayer& from, const Visit& visit) {
  const auto all = [&visit](Target target, auto& some, const auto& others) {
    for (std::size_t i = 0; i < some.size(); ++i) visit(target, some[i], others[i]);
  };
  // The mouth differs most from our units.
  all(kMouthUnits, look.residuals, from.look.residuals);
  for (const Side side : kSides) {
    all(kGaze, look.gaze[side], from.look.gaze[side]);
    visit(kLids, to.blink[side], from.blink[side]);
  }
  all(kMouth, to.mouth, from.mouth);
  all(kMouth, to.mouth_by_hand, from.mouth_by_hand);
  visit(kMouth, to.seal, from.seal);
  visit(kMouth, to.tongue, from.tongue);
  all(kHead, to.head_rotation, from.head_rotation);
  visit(kHead, to.head_forward_mm, from.head_forward_mm);
}

void Mixer::AddLayer(const MotionLayer& layer, const Rules& rules, const Factors& factors,
                     const UnitRegions& regions, MotionLayer& total) const {
  const bool unweighted = rules.weights.empty();
  for (const Side side : kSides) {
    const UnitValues& asked = layer.look.au[side];
    if (asked.AtRest()) continue;
    const std::span strengths(asked.begin(), asked.size());
    for (std::size_t unit = 0; unit < strengths.size(); ++unit) {
      if (strengths[unit] == 0) continue;
      const double weight = unweighted ? 1 : UnitFactor(factors, regions, unit);
      targets_[kUnits].Accumulate(total.look.au[side][unit], weight * strengths[unit]);
    }
  }
  ForEachValue(total, total.look, layer, [&](Target target, float& sum, float asked) {
    RuleOf(target).Accumulate(sum, FactorOf(factors, target) * asked);
  });
}

void Mixer::Mix(const MotionLayers& layers, const UnitRegions& regions, FaceState& state) const {
  MotionLayer total;
  for (const auto& [name, layer] : layers.all()) {
    const Rules& rules = RulesOf(name);
    const Factors factors = FactorsOf(rules, layers);
    AddLayer(layer, rules, factors, regions, total);
    if (!rules.steady) continue;
    const Steady& steady = *rules.steady;
    const double share = steady.signal.empty() ? 1 : layers.Signal(steady.signal);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto rotation = static_cast<float>(factors[kHead] * layer.head_rotation[axis]);
      const auto back =
          static_cast<float>(share * std::clamp(rotation, -steady.limit_deg, steady.limit_deg));
      for (const Side side : kSides) total.look.gaze[side][axis] -= back;
    }
  }
  Store(total, FactorsOf(result_, layers), regions, state);
}

void Mixer::Store(const MotionLayer& total, const Factors& factors, const UnitRegions& regions,
                  FaceState& state) const {
  for (const Side side : kSides) {
    std::size_t unit = 0;
    ForEachUnit(state.au[side], total.look.au[side], [&](float& strength, float value) {
      float limited = targets_[kUnits].Clamped(value);
      if (limited != 0) limited = static_cast<float>(UnitFactor(factors, regions, unit) * limited);
      strength = limited;
      ++unit;
    });
  }
  ForEachValue(state, state, total, [&](Target target, float& value, float sum) {
    value = static_cast<float>(FactorOf(factors, target) * RuleOf(target).Clamped(sum));
  });
}

}  // namespace fsm
