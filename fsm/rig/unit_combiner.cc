#include "fsm/rig/unit_combiner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fsm/base/random.h"

namespace fsm {
namespace {

constexpr float kMaxLean = 0.035f;    // share by which a side may be stronger or weaker; ours
constexpr int kLeanStream = 90;       // of noise, and those that follow, one for each seed
constexpr float kMaxAsymmetry = 5;    // factor on the lean
constexpr float kStretchRate = 0.5f;  // of a strength above 1, where tissue stops stretching

std::size_t At(int unit) { return static_cast<std::size_t>(unit); }

float Acting(float strength) {
  if (!(strength > 0)) return 0;
  strength = std::min(strength, kMaxStrength);
  return strength <= 1 ? strength : 1 + kStretchRate * (strength - 1);
}

}  // namespace

UnitCombiner::UnitCombiner(const UnitTable& table, std::optional<int> asymmetry_seed)
    : rules_(table.rules()) {
  if (!asymmetry_seed) return;
  for (std::size_t unit = 1; unit < kActionUnits; ++unit) {
    if (unit >= kLidDroop || unit == kJawDrop || unit == kMouthStretch) continue;
    const float lean = kMaxLean * NoiseAt(static_cast<int>(unit), kLeanStream + *asymmetry_seed);
    lean_.right[unit] = lean;
    lean_.left[unit] = -lean;
  }
}

Sided<UnitValues> UnitCombiner::ActingUnits(const FaceState& state) const {
  Sided<UnitValues> au;
  const float shown =
      std::isfinite(state.asymmetry) ? std::clamp(state.asymmetry, 0.0f, kMaxAsymmetry) : 0;
  for (const Side side : kSides) {
    for (std::size_t i = 1; i < state.au[side].size(); ++i) {
      const float acting = Acting(state.au[side][i]);
      const float lean = std::as_const(lean_[side])[i];
      if (acting > 0) au[side][i] = (1 + shown * lean) * acting;
    }
  }
  for (UnitValues* const side : {&au.right, &au.left}) {
    UnitValues& acting = *side;
    const auto before = acting;  // rules read what was commanded, so their order does not matter
    for (const UnitTable::Rule& rule : rules_) {
      const float a = before[At(rule.a)];
      const float b = before[At(rule.b)];
      if (rule.kind == UnitTable::Rule::Kind::kDamp) {
        acting[At(rule.a)] *= 1 - rule.share * std::min(b, 1.0f);
      } else if (rule.kind == UnitTable::Rule::Kind::kOppose) {
        if (a > 0 && b > 0 && a + b > 1) {
          acting[At(rule.a)] /= a + b;
          acting[At(rule.b)] /= a + b;
        }
      } else {
        acting[At(a < b ? rule.a : rule.b)] = 0;
      }
    }
  }
  return au;
}

}  // namespace fsm
