#include "fsm/motion/mixer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <span>

#include "fsm/motion/table_text.h"

namespace fsm {

// ---- the table

class Mixer::Reader {
 public:
  Reader(const std::string& name, std::string_view text) : table_(name, text) {}

  vm::Result<Mixer> Read() {
    for (const TableLine& line : table_.lines()) {
      if (auto read = ReadLine(line); !read) return std::unexpected(read.error());
    }
    for (std::size_t i = 0; i < kChannels; ++i) {
      if (seen_[i]) continue;
      return table_.Wrong(0, fmt::format("no row says how channel '{}' is mixed", kPartNames[i]));
    }
    return std::move(out_);
  }

 private:
  vm::Result<void> ReadLine(const TableLine& line) {
    const std::string& kind = line.words[0];
    const std::size_t count = line.words.size();
    if (kind == "channel" && (count == 3 || count == 5)) return ReadChannel(line);
    if (kind == "weight" && count == 5) return ReadWeight(line);
    if (kind == "steady" && (count == 3 || count == 4)) return ReadSteady(line);
    if ((kind == "layer" || kind == "signal") && count == 2) {
      if (auto named = table_.Name(line, 1, "a name"); !named) return named;
      if (kind == "signal") {
        signals_.insert(line.words[1]);
        return {};
      }
      if (LayerAt(line) || line.words[1] == "result") {
        return table_.Wrong(line.number, "the layer '" + line.words[1] + "' is here twice");
      }
      out_.layers_.emplace_back(line.words[1], Rules{});
      return {};
    }
    return table_.Wrong(line.number,
                        fmt::format("'{}' found; channel NAME sum|greatest [LOWEST HIGHEST], layer "
                                    "NAME, signal NAME, weight LAYER CHANNEL SIGNAL FACTOR or "
                                    "steady LAYER LIMIT [SIGNAL] expected",
                                    fmt::join(line.words, " ")));
  }

  vm::Result<void> ReadChannel(const TableLine& line) {
    const auto found = std::ranges::find(kPartNames, line.words[1]);
    const auto index = static_cast<std::size_t>(found - kPartNames.begin());
    const std::string& how = line.words[2];
    if (index >= kChannels || (how != "sum" && how != "greatest")) {
      return table_.Wrong(
          line.number,
          fmt::format("'{} {}' found; {} with sum or greatest expected", line.words[1], how,
                      fmt::join(kPartNames.begin(), kPartNames.begin() + kChannels, ", ")));
    }
    Channel& channel = out_.channels_[index];
    channel = {.greatest = how == "greatest"};
    seen_[index] = true;
    if (line.words.size() == 3) return {};
    const auto lowest = table_.Number(line, 3, "the lowest value", -1000, 1000);
    if (!lowest) return std::unexpected(lowest.error());
    const auto highest = table_.Number(line, 4, "the highest value", *lowest, 1000);
    if (!highest) return std::unexpected(highest.error());
    channel.lowest = static_cast<float>(*lowest);
    channel.highest = static_cast<float>(*highest);
    return {};
  }

  vm::Result<Rules*> LayerAt(const TableLine& line) {
    const auto found =
        std::ranges::find(out_.layers_, line.words[1], &std::pair<std::string, Rules>::first);
    if (found != out_.layers_.end()) return &found->second;
    return table_.Wrong(line.number, fmt::format("'{}' is no layer of a row above", line.words[1]));
  }

  vm::Result<std::string> SignalAt(const TableLine& line, std::size_t word) {
    if (signals_.contains(line.words[word])) return line.words[word];
    return table_.Wrong(line.number,
                        fmt::format("'{}' is no signal of a row above", line.words[word]));
  }

  vm::Result<void> ReadWeight(const TableLine& line) {
    const auto layer =
        line.words[1] == "result" ? vm::Result<Rules*>(&out_.result_) : LayerAt(line);
    if (!layer) return std::unexpected(layer.error());
    const auto part = std::ranges::find(kPartNames, line.words[2]);
    if (part == kPartNames.end()) {
      return table_.Wrong(line.number, fmt::format("'{}' found; {} expected", line.words[2],
                                                   fmt::join(kPartNames, ", ")));
    }
    const auto signal = SignalAt(line, 3);
    if (!signal) return std::unexpected(signal.error());
    const auto factor = table_.Number(line, 4, "a factor", 0, 10);
    if (!factor) return std::unexpected(factor.error());
    (*layer)->weights.push_back({static_cast<Part>(part - kPartNames.begin()), *signal, *factor});
    return {};
  }

  vm::Result<void> ReadSteady(const TableLine& line) {
    const auto layer = LayerAt(line);
    if (!layer) return std::unexpected(layer.error());
    const auto limit = table_.Number(line, 2, "a limit in degrees", 0, 180);
    if (!limit) return std::unexpected(limit.error());
    const auto signal = line.words.size() == 4 ? SignalAt(line, 3) : vm::Result<std::string>("");
    if (!signal) return std::unexpected(signal.error());
    (*layer)->steady = Steady{static_cast<float>(*limit), *signal};
    return {};
  }

  TableText table_;
  Mixer out_;
  std::array<bool, kChannels> seen_{};
  std::set<std::string> signals_;
};

vm::Result<Mixer> Mixer::Read(const std::string& name, std::string_view text) {
  return Reader(name, text).Read();
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
    weights[rule.part] *= 1 - (1 - rule.factor) * frame.Signal(rule.signal);
  }
  return weights;
}

double Mixer::OfUnit(const Weights& weights, const UnitList& units, std::size_t unit) {
  constexpr std::array<Part, kRegions> kPartOf = {kEye, kBrow, kLips};
  const double own = weights[kPartOf[static_cast<std::size_t>(units.RegionOf(unit))]];
  return weights[kUnits] * own * (units.Opens(unit) ? weights[kOpening] : 1);
}

void Mixer::Add(const MotionLayer& layer, const Rules& rules, const Weights& weights,
                const UnitList& units, MotionLayer& total) const {
  const bool in_full = rules.weights.empty();
  const auto join = [&](Part part, auto& sum, const auto& asked) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      channels_[part].Join(sum[i], weights[part] * asked[i]);
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
  join_units(total.units.left, layer.units.left);
  join_units(total.units.right, layer.units.right);
  join(kGaze, total.units.gaze_left, layer.units.gaze_left);
  join(kGaze, total.units.gaze_right, layer.units.gaze_right);
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
      total.units.gaze_left[axis] -= back;
      total.units.gaze_right[axis] -= back;
    }
  }
  Place(total, WeightsOf(result_, frame), units, state);
}

void Mixer::Place(const MotionLayer& total, const Weights& weights, const UnitList& units,
                  FaceState& state) const {
  const auto result = [&](Part part, float value) {
    return static_cast<float>(weights[part] * channels_[part].Limited(value));
  };
  const auto place = [&](Part part, auto& to, const auto& values) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = result(part, values[i]);
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
  place_units(state.au_left, total.units.left);
  place_units(state.au_right, total.units.right);
  place(kMouth, state.mouth, total.mouth);
  place(kMouth, state.mouth_by_hand, total.mouth_by_hand);
  state.lip_seal = result(kMouth, total.seal);
  state.tongue = result(kMouth, total.tongue);
  place(kHead, state.head_rotation, total.head);
  state.head_forward = result(kHead, total.head_forward_mm);
  // Layers count down as positive, the state's eyes up.
  const auto eye = [&](const EyeAngles& angles) {
    return FaceState::Eye{-result(kGaze, angles[0]), result(kGaze, angles[1])};
  };
  state.eye_left = eye(total.units.gaze_left);
  state.eye_right = eye(total.units.gaze_right);
  state.blink_left = state.blink_right = result(kLids, total.lids_shut);
}

}  // namespace fsm
