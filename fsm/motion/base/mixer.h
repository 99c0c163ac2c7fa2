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

  /// Sets the units, mouth, head, eyes and lids of `state`; the rest is unchanged. `regions` gives
  /// the group of each unit.
  void Mix(const MotionLayers& layers, const UnitRegions& regions, FaceState& state) const;

 private:
  class Reader;
  /// What a rule can weight: five wholes (the channels of the table), then groups of units.
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
  static constexpr std::size_t kWholeTargets = kEyeUnits;

  struct TargetRule {
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
  const TargetRule& RuleOf(Target target) const {
    return targets_[target < kWholeTargets ? target : kUnits];
  }
  static double FactorOf(const Factors& factors, Target target) {
    return target < kWholeTargets ? factors[target] : factors[kUnits] * factors[target];
  }
  /// Calls `visit(target, value of to, value of from)` for all but the strengths of units; `look`
  /// is where `to` has residuals and gaze.
  template <typename To, typename Look, typename Visit>
  static void ForEachValue(To& to, Look& look, const MotionLayer& from, const Visit& visit);
  static double UnitFactor(const Factors& factors, const UnitRegions& regions, std::size_t unit);
  void AddLayer(const MotionLayer& layer, const Rules& rules, const Factors& factors,
                const UnitRegions& regions, MotionLayer& total) const;
  void Store(const MotionLayer& total, const Factors& factors, const UnitRegions& regions,
             FaceState& state) const;

  std::array<TargetRule, kWholeTargets> targets_;
  std::vector<std::pair<std::string, Rules>> layers_;
  Rules result_;
};

}  // namespace fsm
