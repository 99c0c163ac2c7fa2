#include "fsm/rig/unit_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <set>
#include <utility>

#include "fsm/base/random.h"
#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

constexpr float kMaxLean = 0.035f;    // share by which a side may be stronger or weaker; ours
constexpr int kLeanStream = 90;       // of noise, and those that follow, one for each seed
constexpr float kMaxAsymmetry = 5;    // factor on the lean
constexpr float kStretchRate = 0.5f;  // of a strength above 1, where tissue stops stretching
constexpr float kSidewaysMeetMm = 4;  // from the median, where movement across it fades

std::size_t At(int unit) { return static_cast<std::size_t>(unit); }

int ReadUnit(const TableRow& row, std::size_t index) {
  const int unit = row.Integer(index);
  if (unit < 1 || unit > static_cast<int>(UnitValues::kMax) || unit == 3 || unit == 40) {
    row.Refuse("'" + row.Word(index) + "' is no action unit (1, 2, 4-39, 41-999)");
  }
  return unit;
}

UnitTable::Field ReadField(const TableRow& row) {
  constexpr float kFace = 300, kMax = 100;  // millimetres
  UnitTable::Field field{};
  field.unit = ReadUnit(row, 1);
  field.centre = {row.Within(2, -kFace, kFace), row.Within(3, -kFace, kFace)};
  field.radius = {row.Within(4, -kFace, kFace), row.Within(5, -kFace, kFace)};
  if (field.radius.x <= 0 || field.radius.y <= 0) row.Refuse("a radius must be positive");
  const std::string& lip = row.Word(6);
  if (lip == "above") {
    field.lip = Lip::kUpper;
  } else if (lip == "below") {
    field.lip = Lip::kLower;
  } else if (lip != "both") {
    row.Refuse("'" + lip + "' found where above, below or both was expected");
  }
  field.displacement = {row.Within(7, -kMax, kMax), row.Within(8, -kMax, kMax),
                        row.Within(9, -kMax, kMax)};
  row.EndsAt(10);
  return field;
}

// Each calls `v` with the numbers of an effect, in their order in a row, and the limits on their
// absolute values.
void VisitNumbers(LidEffect& lid, const auto& v) { v(lid.upper_mm, 20), v(lid.lower_mm, 20); }
void VisitNumbers(CloseEffect& close, const auto& v) { v(close.part, 1); }
void VisitNumbers(JawEffect& jaw, const auto& v) { v(jaw.degrees, 60), v(jaw.slide_mm, 30); }
void VisitNumbers(SwayEffect& sway, const auto& v) { v(sway.mm, 30); }
void VisitNumbers(SealEffect& seal, const auto& v) { v(seal.part, 1); }
void VisitNumbers(TongueEffect& tongue, const auto& v) { v(tongue.raise, 1), v(tongue.out_mm, 60); }
void VisitNumbers(CreaseEffect& crease, const auto& v) {
  for (float& depth : crease.depth) v(depth, 1);
}

template <typename Effect>
UnitEffect ReadEffect(const TableRow& row) {
  Effect effect{};
  std::size_t index = 2;
  VisitNumbers(effect, [&](float& n, float limit) { n = row.Within(index++, -limit, limit); });
  row.EndsAt(index);
  return effect;
}

/// A kind of row that gives an effect: its key word, and what reads it. In the order of UnitEffect.
struct EffectRow {
  std::string_view key;
  UnitEffect (*read)(const TableRow&);
};
constexpr std::array<EffectRow, std::variant_size_v<UnitEffect>> kEffectRows{
    {{"lid", ReadEffect<LidEffect>},
     {"close", ReadEffect<CloseEffect>},
     {"jaw", ReadEffect<JawEffect>},
     {"sway", ReadEffect<SwayEffect>},
     {"seal", ReadEffect<SealEffect>},
     {"tongue", ReadEffect<TongueEffect>},
     {"crease", ReadEffect<CreaseEffect>}}};

float Stronger(Sided<float> of) { return std::max(of.left, of.right); }

// Each adds an effect of a unit with the strengths `of` to a sum.
void AddEffect(const LidEffect& lid, Sided<float> of, UnitEffects& sum) {
  for (const Side s : kSides) {
    sum.lids[s].upper_mm += lid.upper_mm * of[s];
    sum.lids[s].lower_mm += lid.lower_mm * of[s];
  }
}
void AddEffect(const CloseEffect& close, Sided<float> of, UnitEffects& sum) {
  for (const Side s : kSides) sum.lids[s].close = std::max(sum.lids[s].close, close.part * of[s]);
}
void AddEffect(const JawEffect& jaw, Sided<float> of, UnitEffects& sum) {
  sum.jaw_degrees += jaw.degrees * Stronger(of);
  sum.jaw_slide_mm += jaw.slide_mm * Stronger(of);
}
void AddEffect(const SwayEffect& sway, Sided<float> of, UnitEffects& sum) {
  sum.jaw_sway_mm += sway.mm * (of.left - of.right);
}
void AddEffect(const SealEffect& seal, Sided<float> of, UnitEffects& sum) {
  sum.seal = std::max(sum.seal, seal.part * Stronger(of));
}
void AddEffect(const TongueEffect& tongue, Sided<float> of, UnitEffects& sum) {
  sum.tongue_raise += tongue.raise * Stronger(of);
  sum.tongue_out_mm += tongue.out_mm * Stronger(of);
}
void AddEffect(const CreaseEffect&, Sided<float>, UnitEffects&) {}  // see CreaseDepths

/// A kind of row that gives a rule, in the order of UnitTable::Rule::Kind: its key word, and
/// whether a number (Rule::share) follows the two units.
struct RuleRow {
  std::string_view key;
  bool has_share = false;
};
constexpr std::array<RuleRow, 3> kRuleRows{{{"damp", true}, {"oppose"}, {"strongest"}}};

std::string Digits(float number) {
  std::array<char, 32> digits;
  std::snprintf(digits.data(), digits.size(), " %.9g", static_cast<double>(number));
  return digits.data();
}

float Acting(float strength) {
  if (!(strength > 0)) return 0;
  strength = std::min(strength, kMaxStrength);
  return strength <= 1 ? strength : 1 + kStretchRate * (strength - 1);
}

}  // namespace

UnitTable::UnitTable(const Table& table) {
  for (const TableRow& row : table.rows()) Add(row);
}

bool UnitTable::IsRule(std::string_view key) {
  return std::ranges::find(kRuleRows, key, &RuleRow::key) != kRuleRows.end();
}

void UnitTable::Add(const TableRow& row) {
  const std::string& key = row.key();
  if (fields_.size() + effects_.size() + rules_.size() >= kMaxRows) {
    row.Refuse("more rows than are read (" + std::to_string(kMaxRows) + ")");
  }
  const auto effect = std::ranges::find(kEffectRows, key, &EffectRow::key);
  const auto rule = std::ranges::find(kRuleRows, key, &RuleRow::key);
  if (key == "field") {
    fields_.push_back(ReadField(row));
  } else if (effect != kEffectRows.end()) {
    effects_.push_back({ReadUnit(row, 1), effect->read(row)});
  } else if (rule != kRuleRows.end()) {
    rules_.push_back({static_cast<Rule::Kind>(rule - kRuleRows.begin()), ReadUnit(row, 1),
                      ReadUnit(row, 2), rule->has_share ? row.Within(3, 0, 1) : 0});
    row.EndsAt(rule->has_share ? 4 : 3);
  } else {
    row.Refuse("unknown word '" + key + "'");
  }
}

void UnitTable::Add(const UnitTable& more) {
  fields_.insert(fields_.end(), more.fields_.begin(), more.fields_.end());
  effects_.insert(effects_.end(), more.effects_.begin(), more.effects_.end());
  rules_.insert(rules_.end(), more.rules_.begin(), more.rules_.end());
}

std::string UnitTable::Text() const {
  std::string text;
  const auto row = [&text](std::string_view key, std::initializer_list<float> numbers) {
    text += (text.empty() ? "" : "\n") + std::string(key);
    for (const float number : numbers) text += Digits(number);
  };
  const auto number = [](int unit) { return static_cast<float>(unit); };
  for (const Field& field : fields_) {
    row("field",
        {number(field.unit), field.centre.x, field.centre.y, field.radius.x, field.radius.y});
    text += !field.lip ? " both" : *field.lip == Lip::kUpper ? " above" : " below";
    for (int k = 0; k < 3; ++k) text += Digits(field.displacement[k]);
  }
  for (const Effect& effect : effects_) {
    row(kEffectRows[effect.effect.index()].key, {number(effect.unit)});
    std::visit(
        [&text](auto what) { VisitNumbers(what, [&](float n, float) { text += Digits(n); }); },
        effect.effect);
  }
  for (const Rule& rule : rules_) {
    const RuleRow& kind = kRuleRows[static_cast<std::size_t>(rule.kind)];
    row(kind.key, {number(rule.a), number(rule.b)});
    if (kind.has_share) text += Digits(rule.share);
  }
  return text;
}

void UnitTable::MakeAsymmetric(int seed) {
  for (std::size_t unit = 1; unit < kActionUnits; ++unit) {
    if (unit >= kLidDroop || unit == kJawDrop || unit == kMouthStretch) continue;
    const float lean = kMaxLean * NoiseAt(static_cast<int>(unit), kLeanStream + seed);
    lean_.right[unit] = lean;
    lean_.left[unit] = -lean;
  }
}

std::vector<int> UnitTable::Numbers() const {
  std::set<int> numbers;
  for (const Field& field : fields_) numbers.insert(field.unit);
  for (const Effect& effect : effects_) numbers.insert(effect.unit);
  return {numbers.begin(), numbers.end()};
}

Sided<UnitValues> UnitTable::ActingUnits(const FaceState& state) const {
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
    const auto before = acting;  // rules read what was asked, so their order does not matter
    for (const Rule& rule : rules_) {
      const float a = before[At(rule.a)];
      const float b = before[At(rule.b)];
      if (rule.kind == Rule::Kind::kDamp) {
        acting[At(rule.a)] *= 1 - rule.share * std::min(b, 1.0f);
      } else if (rule.kind == Rule::Kind::kOppose) {
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

UnitEffects UnitTable::Effects(const Sided<UnitValues>& au) const {
  UnitEffects sum;
  for (const auto& [unit, what] : effects_) {
    const Sided<float> of{au.right[At(unit)], au.left[At(unit)]};
    std::visit([&](const auto& effect) { AddEffect(effect, of, sum); }, what);
  }
  return sum;
}

glm::vec3 UnitTable::FieldDisplacement(const Field& field, const SkinWeights& weights, Side side) {
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

Creases UnitTable::CreaseDepths(const Sided<UnitValues>& au,
                                const std::array<float, kLastingCreases>& at_rest) const {
  Creases creases{};
  for (const Side side : kSides) {
    for (std::size_t k = 0; k < kLastingCreases; ++k) creases[k][side] = at_rest[k];
    for (const auto& [unit, what] : effects_) {
      const auto* const effect = std::get_if<CreaseEffect>(&what);
      for (std::size_t k = 0; effect && k < kCreases; ++k)
        creases[k][side] += effect->depth[k] * au[side][At(unit)];
    }
    for (Sided<float>& depth : creases) depth[side] = std::clamp(depth[side], 0.0f, 1.0f);
  }
  return creases;
}

}  // namespace fsm
