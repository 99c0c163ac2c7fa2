#include "fsm/motion/base/mixer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "fsm/base/table_reader.h"

namespace fsm {

struct Mixer::Rules {
  /// What a rule can weight: five wholes (the channels of the table), then groups of units.
  enum Channel {
    kUnits,
    kMouth,
    kHead,
    kGaze,
    kLids,
    kEyeUnits,
    kBrowUnits,
    kMouthUnits,
    kOpeningUnits,
    kChannels
  };
  static constexpr std::array<std::string_view, kChannels> kNames = {
      "units",     "mouth",      "head",        "gaze",         "lids",
      "eye_units", "brow_units", "mouth_units", "opening_units"};
  static constexpr std::size_t kWholeChannels = kEyeUnits;
  using Factors = std::array<double, kChannels>;

  struct ChannelRule {
    bool greatest = false;  // takes the greatest value; else the sum
    float min = -std::numeric_limits<float>::infinity();
    float max = std::numeric_limits<float>::infinity();

    void Accumulate(float& total, double asked) const {
      const auto more = static_cast<float>(asked);
      total = greatest ? std::max(total, more) : total + more;
    }
    float Clamped(float total) const { return std::clamp(total, min, max); }
  };
  struct WeightRule {
    Channel channel;
    std::string signal;
    double factor;
  };
  struct Steady {
    float limit_deg;
    std::string signal;  // "" = always
  };
  struct LayerRules {
    std::vector<WeightRule> weights;
    std::optional<Steady> steady;

    Factors FactorsOf(const MotionLayers& all) const {
      Factors factors;
      factors.fill(1);
      for (const WeightRule& rule : weights) {
        factors[rule.channel] *= 1 - (1 - rule.factor) * all.Signal(rule.signal);
      }
      return factors;
    }
  };

  const LayerRules& RulesOf(std::string_view layer) const {
    static const LayerRules kNone;
    for (const auto& [name, rules] : layers) {
      if (name == layer) return rules;
    }
    return kNone;
  }
  /// A group's rule is that of the units, and it is weighted by their factor and its own.
  const ChannelRule& RuleOf(Channel channel) const {
    return channels[channel < kWholeChannels ? channel : kUnits];
  }
  static double FactorOf(const Factors& factors, Channel channel) {
    return channel < kWholeChannels ? factors[channel] : factors[kUnits] * factors[channel];
  }
  static double UnitFactor(const Factors& factors, const UnitRegions& regions, std::size_t unit) {
    constexpr std::array<Channel, kRegions> kChannelOf = {kEyeUnits, kBrowUnits, kMouthUnits};
    const Channel channel = kChannelOf[static_cast<std::size_t>(regions.RegionOf(unit))];
    return FactorOf(factors, channel) * (regions.Opens(unit) ? factors[kOpeningUnits] : 1);
  }

  /// Calls `visit(channel, value of to, value of from)` for all but the strengths of units; `look`
  /// is where `to` has residuals and gaze.
  static void ForEachValue(auto& to, auto& look, const MotionLayer& from, const auto& visit) {
    const auto all = [&visit](Channel channel, auto& some, const auto& others) {
      for (std::size_t i = 0; i < some.size(); ++i) visit(channel, some[i], others[i]);
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

  void AddLayer(const MotionLayer& layer, bool weighted, const Factors& factors,
                const UnitRegions& regions, MotionLayer& total) const {
    for (const Side side : kSides) {
      const UnitValues& asked = layer.look.au[side];
      if (asked.AtRest()) continue;
      const std::span strengths(asked.begin(), asked.size());
      for (std::size_t unit = 0; unit < strengths.size(); ++unit) {
        if (strengths[unit] == 0) continue;
        const double weight = weighted ? UnitFactor(factors, regions, unit) : 1;
        channels[kUnits].Accumulate(total.look.au[side][unit], weight * strengths[unit]);
      }
    }
    ForEachValue(total, total.look, layer, [&](Channel channel, float& sum, float asked) {
      RuleOf(channel).Accumulate(sum, FactorOf(factors, channel) * asked);
    });
  }

  void Store(const MotionLayer& total, const Factors& factors, const UnitRegions& regions,
             FaceState& state) const {
    for (const Side side : kSides) {
      std::size_t unit = 0;
      ForEachUnit(state.au[side], total.look.au[side], [&](float& strength, float value) {
        float limited = channels[kUnits].Clamped(value);
        if (limited != 0) {
          limited = static_cast<float>(UnitFactor(factors, regions, unit) * limited);
        }
        strength = limited;
        ++unit;
      });
    }
    ForEachValue(state, state, total, [&](Channel channel, float& value, float sum) {
      value = static_cast<float>(FactorOf(factors, channel) * RuleOf(channel).Clamped(sum));
    });
  }

  std::array<ChannelRule, kWholeChannels> channels;
  std::vector<std::pair<std::string, LayerRules>> layers;
  LayerRules result;
};

class Mixer::Reader {
 public:
  Rules Read(const Table& table) {
    for (const TableRow& row : table.rows()) ReadRow(row);
    for (std::size_t i = 0; i < Rules::kWholeChannels; ++i) {
      if (seen_[i]) continue;
      table.Refuse(fmt::format("no row says how channel '{}' is mixed", Rules::kNames[i]));
    }
    return std::move(out_);
  }

 private:
  void ReadRow(const TableRow& row) {
    const std::string& kind = row.key();
    const std::size_t count = row.size();
    if (kind == "channel" && (count == 3 || count == 5)) return ReadChannel(row);
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

  void ReadChannel(const TableRow& row) {
    constexpr auto& kNames = Rules::kNames;
    const auto found = std::ranges::find(kNames, row.Word(1));
    const auto index = static_cast<std::size_t>(found - kNames.begin());
    const std::string& how = row.Word(2);
    if (index >= Rules::kWholeChannels || (how != "sum" && how != "greatest")) {
      row.Refuse(
          fmt::format("'{} {}' found; {} with sum or greatest expected", row.Word(1), how,
                      fmt::join(kNames.begin(), kNames.begin() + Rules::kWholeChannels, ", ")));
    }
    Rules::ChannelRule& channel = out_.channels[index];
    channel = {.greatest = how == "greatest"};
    seen_[index] = true;
    if (row.size() == 3) return;
    channel.min = row.Within(3, -1000, 1000, "the lowest value");
    channel.max = row.Within(4, channel.min, 1000, "the highest value");
  }

  Rules::LayerRules* FindLayer(std::string_view name) {
    for (auto& [other, rules] : out_.layers) {
      if (other == name) return &rules;
    }
    return nullptr;
  }

  Rules::LayerRules& LayerAt(const TableRow& row) {
    Rules::LayerRules* const layer = FindLayer(row.Word(1));
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
    out_.layers.emplace_back(name, Rules::LayerRules{});
  }

  void ReadWeight(const TableRow& row) {
    Rules::LayerRules& layer = row.Word(1) == "result" ? out_.result : LayerAt(row);
    const auto found = std::ranges::find(Rules::kNames, row.Word(2));
    if (found == Rules::kNames.end()) {
      row.Refuse(
          fmt::format("'{}' found; {} expected", row.Word(2), fmt::join(Rules::kNames, ", ")));
    }
    layer.weights.push_back({static_cast<Rules::Channel>(found - Rules::kNames.begin()),
                             SignalAt(row, 3), row.Within<double>(4, 0, 10, "a factor")});
  }

  void ReadSteady(const TableRow& row) {
    Rules::LayerRules& layer = LayerAt(row);
    layer.steady = Rules::Steady{row.Within(2, 0, 180, "a limit in degrees"),
                                 row.size() == 4 ? SignalAt(row, 3) : ""};
  }

  Rules out_;
  std::array<bool, Rules::kWholeChannels> seen_{};
  std::set<std::string> signals_;
};

vm::Result<Mixer> Mixer::Read(const std::string& name, std::string_view text) {
  return ReadTable(name, text, [](const Table& table) {
    Mixer mixer;
    mixer.rules_ = std::make_shared<const Rules>(Reader().Read(table));
    return mixer;
  });
}

void Mixer::Mix(const MotionLayers& layers, const UnitRegions& regions, FaceState& state) const {
  MotionLayer total;
  for (const auto& [name, layer] : layers.all()) {
    const Rules::LayerRules& rules = rules_->RulesOf(name);
    const Rules::Factors factors = rules.FactorsOf(layers);
    rules_->AddLayer(layer, !rules.weights.empty(), factors, regions, total);
    if (!rules.steady) continue;
    const Rules::Steady& steady = *rules.steady;
    const double share = steady.signal.empty() ? 1 : layers.Signal(steady.signal);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto rotation = static_cast<float>(factors[Rules::kHead] * layer.head_rotation[axis]);
      const auto back =
          static_cast<float>(share * std::clamp(rotation, -steady.limit_deg, steady.limit_deg));
      for (const Side side : kSides) total.look.gaze[side][axis] -= back;
    }
  }
  rules_->Store(total, rules_->result.FactorsOf(layers), regions, state);
}

}  // namespace fsm
