#include "fsm/rig/unit_effects.h"

#include <algorithm>
#include <cmath>

#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

constexpr float kSidewaysMeetMm = 4;  // from the median, where movement across it fades

std::size_t IndexOf(int unit) { return static_cast<std::size_t>(unit); }

float Stronger(Sided<float> of) { return std::max(of.left, of.right); }

// Each adds an effect of a unit with the strengths `of` to a sum.
void AddEffect(const LidEffect& lid, Sided<float> of, UnitEffects& sum) {
  for (const Side s : kSides) {
    sum.lids[s].upper_mm += lid.upper_mm * of[s];
    sum.lids[s].lower_mm += lid.lower_mm * of[s];
  }
}
void AddEffect(const CloseEffect& close, Sided<float> of, UnitEffects& sum) {
  for (const Side s : kSides) sum.lids[s].close = std::max(sum.lids[s].close, close.share * of[s]);
}
void AddEffect(const JawEffect& jaw, Sided<float> of, UnitEffects& sum) {
  sum.jaw_degrees += jaw.degrees * Stronger(of);
  sum.jaw_slide_mm += jaw.slide_mm * Stronger(of);
}
void AddEffect(const SwayEffect& sway, Sided<float> of, UnitEffects& sum) {
  sum.jaw_sway_mm += sway.mm * (of.left - of.right);
}
void AddEffect(const SealEffect& seal, Sided<float> of, UnitEffects& sum) {
  sum.seal = std::max(sum.seal, seal.share * Stronger(of));
}
void AddEffect(const TongueEffect& tongue, Sided<float> of, UnitEffects& sum) {
  sum.tongue_raise += tongue.raise * Stronger(of);
  sum.tongue_out_mm += tongue.out_mm * Stronger(of);
}
void AddEffect(const CreaseEffect&, Sided<float>, UnitEffects&) {}  // see CreaseDepths

}  // namespace

UnitEffects SumEffects(const UnitTable& table, const Sided<UnitValues>& au) {
  UnitEffects sum;
  for (const auto& [unit, what] : table.effects()) {
    const Sided<float> of{au.right[IndexOf(unit)], au.left[IndexOf(unit)]};
    std::visit([&](const auto& effect) { AddEffect(effect, of, sum); }, what);
  }
  return sum;
}

glm::vec3 FieldDisplacement(const UnitTable::Field& field, const SkinWeights& weights, Side side) {
  const float x = SignOf(side) * weights.domain.x;
  if (std::abs(weights.domain.y - field.centre.y) >= field.radius.y) return glm::vec3(0);
  // Both sides act at the median, half each, so that left and right add up to the whole.
  const float own_side = LeftShareAt(x);
  if (own_side <= 0) return glm::vec3(0);
  float weight = 0;
  // A field that reaches over the median overlaps its mirror image; the stronger one counts.
  for (const float image : {1.0f, -1.0f}) {
    const float dx = (x - image * field.centre.x) / field.radius.x;
    const float dy = (weights.domain.y - field.centre.y) / field.radius.y;
    const float d2 = dx * dx + dy * dy;
    if (d2 < 1) weight = std::max(weight, (1 - d2) * (1 - d2));
  }
  if (field.lip == Lip::kUpper) weight *= weights.above_mouth;
  if (field.lip == Lip::kLower) weight *= 1 - weights.above_mouth;
  weight *= own_side * weights.free;
  glm::vec3 displacement = field.displacement;
  // The sideways component changes sign smoothly at the median, so that the skin does not tear.
  displacement.x *= std::clamp(x / kSidewaysMeetMm, -1.0f, 1.0f) * SignOf(side);
  return weight * displacement;
}

float LeftShareAt(float x_mm) { return SmoothStep(-7, 7, x_mm); }

Creases CreaseDepths(const UnitTable& table, const Sided<UnitValues>& au,
                     const std::array<float, kLastingCreases>& at_rest) {
  Creases creases{};
  for (const Side side : kSides) {
    for (std::size_t k = 0; k < kLastingCreases; ++k) creases[k][side] = at_rest[k];
    Of(creases, Crease::kForeheadSides)[side] = Of(creases, Crease::kForehead)[side];
    for (const auto& [unit, what] : table.effects()) {
      const auto* const effect = std::get_if<CreaseEffect>(&what);
      for (std::size_t k = 0; effect && k < kCreases; ++k)
        creases[k][side] += effect->depth[k] * au[side][IndexOf(unit)];
    }
    for (Sided<float>& depth : creases) depth[side] = std::clamp(depth[side], 0.0f, 1.0f);
  }
  return creases;
}

}  // namespace fsm
