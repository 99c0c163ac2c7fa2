#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/base/unit_list.h"
#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Combines the layers of all sources at one instant into a state of the face, by the rules of
/// tables/mixing.txt. A value, constant after Read; thread: any.
class Mixer {
 public:
  /// Reads the rules. Errors: kBadValue "NAME:LINE: ..." for a malformed row, and for names that no
  /// earlier row declares.
  static vm::Result<Mixer> Read(const std::string& name, std::string_view text);

  /// Sets the units, mouth, head, eyes and lids of `state`; the rest is unchanged. `units` gives
  /// the group of each unit.
  void Mix(const MotionLayers& layers, const UnitList& units, FaceState& state) const;

 private:
  class Reader;
  /// What a rule can weight: the channels, then groups within the units.
  enum Target {
    kUnits,
    kMouth,
    kHead,
    kGaze,
    kLids,
    kEyeUnits,
    kBrowUnits,
    kMouthUnits,
    kOpeningUnits,
    kTargets
  };
  static constexpr std::array<std::string_view, kTargets> kTargetNames = {
      "units",     "mouth",      "head",        "gaze",         "lids",
      "eye_units", "brow_units", "mouth_units", "opening_units"};
  static constexpr std::size_t kChannels = kEyeUnits;

  struct ChannelRule {
    bool greatest = false;  // takes the greatest value; else the sum
    float lowest = -std::numeric_limits<float>::infinity();
    float highest = std::numeric_limits<float>::infinity();

    void Accumulate(float& total, double asked) const {
      const auto more = static_cast<float>(asked);
      total = greatest ? std::max(total, more) : total + more;
    }
    float Clamped(float total) const { return std::clamp(total, lowest, highest); }
  };
  struct WeightRule {
    Target target;
    std::string signal;
    double factor;
  };
  struct Steady {
    float limit_deg;
    std::string signal;  // "" = always
  };
  struct Rules {
    std::vector<WeightRule> weights;
    std::optional<Steady> steady;
  };
  using Factors = std::array<double, kTargets>;

  const Rules& RulesOf(std::string_view layer) const;
  static Factors FactorsOf(const Rules& rules, const MotionLayers& layers);
  /// A group's rule is that of the units, and it is weighted by their factor and its own.
  const ChannelRule& RuleOf(Target target) const {
    return channels_[target < kChannels ? target : kUnits];
  }
  static double FactorOf(const Factors& factors, Target target) {
    return target < kChannels ? factors[target] : factors[kUnits] * factors[target];
  }
  /// Calls `visit(target, value of to, value of from)` for all but the strengths of units; `look`
  /// is where `to` has residuals and gaze.
  template <typename To, typename Look, typename Visit>
  static void ForEachValue(To& to, Look& look, const MotionLayer& from, const Visit& visit);
  static double UnitFactor(const Factors& factors, const UnitList& units, std::size_t unit);
  void AddLayer(const MotionLayer& layer, const Rules& rules, const Factors& factors,
                const UnitList& units, MotionLayer& total) const;
  void Store(const MotionLayer& total, const Factors& factors, const UnitList& units,
             FaceState& state) const;

  std::array<ChannelRule, kChannels> channels_;
  std::vector<std::pair<std::string, Rules>> layers_;
  Rules result_;
};

}  // namespace fsm
