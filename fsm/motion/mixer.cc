#include "fsm/motion/mixer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <span>

#include "fsm/base/table_reader.h"

namespace fsm {

// ---- the table

class Mixer::Reader {
 public:
  Mixer Read(const Table& table) {
    for (const TableRow& row : table.rows()) ReadRow(row);
    for (std::size_t i = 0; i < kChannels; ++i) {
      if (seen_[i]) continue;
      table.Fail(fmt::format("no row says how channel '{}' is mixed", kWeighedNames[i]));
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
    row.Fail(
        fmt::format("'{}' found; channel NAME sum|greatest [LOWEST HIGHEST], layer NAME, "
                    "signal NAME, weight LAYER CHANNEL SIGNAL FACTOR or steady LAYER LIMIT "
                    "[SIGNAL] expected",
                    fmt::join(row.words(), " ")));
  }

  void ReadChannel(const TableRow& row) {
    const auto found = std::ranges::find(kWeighedNames, row.Word(1));
    const auto index = static_cast<std::size_t>(found - kWeighedNames.begin());
    const std::string& how = row.Word(2);
    if (index >= kChannels || (how != "sum" && how != "greatest")) {
      row.Fail(
          fmt::format("'{} {}' found; {} with sum or greatest expected", row.Word(1), how,
                      fmt::join(kWeighedNames.begin(), kWeighedNames.begin() + kChannels, ", ")));
    }
    ChannelRule& channel = out_.channels_[index];
    channel = {.greatest = how == "greatest"};
    seen_[index] = true;
    if (row.size() == 3) return;
    const double lowest = row.Number(3, "the lowest value", -1000, 1000);
    channel.lowest = static_cast<float>(lowest);
    channel.highest = static_cast<float>(row.Number(4, "the highest value", lowest, 1000));
  }

  Rules* FindLayer(std::string_view name) {
    const auto found = std::ranges::find(out_.layers_, name, &std::pair<std::string, Rules>::first);
    return found == out_.layers_.end() ? nullptr : &found->second;
  }

  Rules& LayerAt(const TableRow& row) {
    Rules* const layer = FindLayer(row.Word(1));
    if (layer == nullptr) row.Fail(fmt::format("'{}' is no layer of a row above", row.Word(1)));
    return *layer;
  }

  const std::string& SignalAt(const TableRow& row, std::size_t word) {
    if (!signals_.contains(row.Word(word))) {
      row.Fail(fmt::format("'{}' is no signal of a row above", row.Word(word)));
    }
    return row.Word(word);
  }

  void ReadLayer(const TableRow& row) {
    const std::string& name = row.Name(1, "a name");
    if (FindLayer(name) != nullptr || name == "result") {
      row.Fail("the layer '" + name + "' is here twice");
    }
    out_.layers_.emplace_back(name, Rules{});
  }

  void ReadWeight(const TableRow& row) {
    Rules& layer = row.Word(1) == "result" ? out_.result_ : LayerAt(row);
    const auto found = std::ranges::find(kWeighedNames, row.Word(2));
    if (found == kWeighedNames.end()) {
      row.Fail(fmt::format("'{}' found; {} expected", row.Word(2), fmt::join(kWeighedNames, ", ")));
    }
    layer.weights.push_back({static_cast<Weighed>(found - kWeighedNames.begin()), SignalAt(row, 3),
                             row.Number(4, "a factor", 0, 10)});
  }

  void ReadSteady(const TableRow& row) {
    Rules& layer = LayerAt(row);
    const auto limit = static_cast<float>(row.Number(2, "a limit in degrees", 0, 180));
    layer.steady = Steady{limit, row.size() == 4 ? SignalAt(row, 3) : ""};
  }

  Mixer out_;
  std::array<bool, kChannels> seen_{};
  std::set<std::string> signals_;
};

vm::Result<Mixer> Mixer::Read(const std::string& name, std::string_view text) {
  return ReadTable(name, text, [](const Table& table) { return Reader().Read(table); });
}

// ---- mixing

const Mixer::Rules& Mixer::RulesOf(std::string_view layer) const {
  static const Rules kInFull;
  for (const auto& [name, rules] : layers_) {
    if (name == layer) return rules;
  }
  return kInFull;
}

Mixer::Weights Mixer::WeightsOf(const Rules& rules, const MotionFrame& frame) {
  Weights weights;
  weights.fill(1);
  for (const Weight& rule : rules.weights) {
    weights[rule.weighed] *= 1 - (1 - rule.factor) * frame.Signal(rule.signal);
  }
  return weights;
}

double Mixer::OfUnit(const Weights& weights, const UnitList& units, std::size_t unit) {
  constexpr std::array<Weighed, kRegions> kWeighedOf = {kEye, kBrow, kLips};
  const double own = weights[kWeighedOf[static_cast<std::size_t>(units.RegionOf(unit))]];
  return weights[kUnits] * own * (units.Opens(unit) ? weights[kOpening] : 1);
}

void Mixer::Add(const MotionLayer& layer, const Rules& rules, const Weights& weights,
                const UnitList& units, MotionLayer& total) const {
  const bool in_full = rules.weights.empty();
  const auto join = [&](Weighed weighed, auto& sum, const auto& asked) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      channels_[weighed].Join(sum[i], weights[weighed] * asked[i]);
    }
  };
  const auto join_units = [&](UnitValues& sum, const UnitValues& asked) {
    // Most layers ask nothing of the units, which is seen fastest in one piece.
    static const UnitValues kRest;
    const std::size_t bytes = kRest.size() * sizeof(float);
    if (asked.size() == kRest.size() && std::memcmp(asked.begin(), kRest.begin(), bytes) == 0) {
      return;
    }
    const std::span strengths(asked.begin(), asked.size());
    for (std::size_t unit = 0; unit < strengths.size(); ++unit) {
      if (strengths[unit] == 0) continue;
      const double weight = in_full ? 1 : OfUnit(weights, units, unit);
      channels_[kUnits].Join(sum[unit], weight * strengths[unit]);
    }
  };
  for (const Side side : kSides) {
    join_units(total.units.au[side], layer.units.au[side]);
    join(kGaze, total.units.gaze[side], layer.units.gaze[side]);
  }
  join(kMouth, total.mouth, layer.mouth);
  join(kMouth, total.mouth_by_hand, layer.mouth_by_hand);
  channels_[kMouth].Join(total.seal, weights[kMouth] * layer.seal);
  channels_[kMouth].Join(total.tongue, weights[kMouth] * layer.tongue);
  join(kHead, total.head, layer.head);
  channels_[kHead].Join(total.head_forward_mm, weights[kHead] * layer.head_forward_mm);
  channels_[kLids].Join(total.lids_shut, weights[kLids] * layer.lids_shut);
}

void Mixer::Mix(const MotionFrame& frame, const UnitList& units, FaceState& state) const {
  MotionLayer total;
  for (const auto& [name, layer] : frame.layers()) {
    const Rules& rules = RulesOf(name);
    const Weights weights = WeightsOf(rules, frame);
    Add(layer, rules, weights, units, total);
    if (!rules.steady) continue;
    const Steady& steady = *rules.steady;
    const double share = steady.signal.empty() ? 1 : frame.Signal(steady.signal);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto turn = static_cast<float>(weights[kHead] * layer.head[axis]);
      const auto back =
          static_cast<float>(share * std::clamp(turn, -steady.limit_deg, steady.limit_deg));
      for (const Side side : kSides) total.units.gaze[side][axis] -= back;
    }
  }
  Place(total, WeightsOf(result_, frame), units, state);
}

void Mixer::Place(const MotionLayer& total, const Weights& weights, const UnitList& units,
                  FaceState& state) const {
  const auto result = [&](Weighed weighed, float value) {
    return static_cast<float>(weights[weighed] * channels_[weighed].Limited(value));
  };
  const auto place = [&](Weighed weighed, auto& to, const auto& values) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = result(weighed, values[i]);
  };
  const auto place_units = [&](UnitValues& to, const UnitValues& values) {
    std::size_t unit = 0;
    Combine(to, values, [&](float& strength, float value) {
      float limited = channels_[kUnits].Limited(value);
      if (limited != 0) limited = static_cast<float>(OfUnit(weights, units, unit) * limited);
      strength = limited;
      ++unit;
    });
  };
  for (const Side side : kSides) place_units(state.au[side], total.units.au[side]);
  place(kMouth, state.mouth, total.mouth);
  place(kMouth, state.mouth_by_hand, total.mouth_by_hand);
  state.lip_seal = result(kMouth, total.seal);
  state.tongue = result(kMouth, total.tongue);
  place(kHead, state.head_rotation, total.head);
  state.head_forward = result(kHead, total.head_forward_mm);
  for (const Side side : kSides) place(kGaze, state.gaze[side], total.units.gaze[side]);
  state.blink.left = state.blink.right = result(kLids, total.lids_shut);
}

}  // namespace fsm
