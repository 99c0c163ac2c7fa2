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

constexpr float kMostLean = 0.035f;   // part by which a side may be stronger or weaker; ours
constexpr float kMostAsymmetry = 5;   // factor on the lean
constexpr float kMostStrength = 2;    // of a unit, the original's 200 %
constexpr float kStretchRate = 0.5f;  // of a strength above 1, where tissue stops stretching
constexpr float kSidewaysMeetMm = 4;  // from the median, where movement across it fades

std::size_t At(int unit) { return static_cast<std::size_t>(unit); }

int ReadUnit(const TableRow& row, std::size_t index) {
  const int unit = row.Integer(index);
  if (unit < 1 || unit > static_cast<int>(UnitValues::kMost) || unit == 3 || unit == 40) {
    row.Fail("'" + row.Word(index) + "' is no action unit (1, 2, 4-39, 41-999)");
  }
  return unit;
}

UnitTable::Field ReadField(const TableRow& row) {
  constexpr float kFace = 300, kMost = 100;  // millimetres
  UnitTable::Field field{};
  field.unit = ReadUnit(row, 1);
  field.at = {row.Within(2, -kFace, kFace), row.Within(3, -kFace, kFace)};
  field.radius = {row.Within(4, -kFace, kFace), row.Within(5, -kFace, kFace)};
  if (field.radius.x <= 0 || field.radius.y <= 0) row.Fail("a radius must be positive");
  const std::string& part = row.Word(6);
  using Lip = UnitTable::Field::Lip;
  if (part == "above") {
    field.lip = Lip::kUpper;
  } else if (part == "below") {
    field.lip = Lip::kLower;
  } else if (part == "both") {
    field.lip = Lip::kBoth;
  } else {
    row.Fail("'" + part + "' found where above, below or both was expected");
  }
  field.by = {row.Within(7, -kMost, kMost), row.Within(8, -kMost, kMost),
              row.Within(9, -kMost, kMost)};
  row.EndsAt(10);
  return field;
}

/// A kind of row that gives an effect, in the order of UnitTable::Effect::Kind: its key word, and
/// the limits on the absolute values of the one or two numbers after the unit.
struct EffectRow {
  std::string_view key;
  float most_first, most_second = 0;
};
constexpr std::array<EffectRow, 6> kEffectRows{
    {{"lid", 20, 20}, {"close", 1}, {"jaw", 60, 30}, {"sway", 30}, {"seal", 1}, {"tongue", 1, 60}}};

/// A kind of row that gives a rule, in the order of UnitTable::Rule::Kind: its key word, and
/// whether a number (Rule::part) follows the two units.
struct RuleRow {
  std::string_view key;
  bool has_part = false;
};
constexpr std::array<RuleRow, 3> kRuleRows{{{"damp", true}, {"oppose"}, {"strongest"}}};

std::string Digits(float number) {
  std::array<char, 32> digits;
  std::snprintf(digits.data(), digits.size(), " %.9g", static_cast<double>(number));
  return digits.data();
}

float Acting(float strength) {
  if (!(strength > 0)) return 0;
  strength = std::min(strength, kMostStrength);
  return strength <= 1 ? strength : 1 + kStretchRate * (strength - 1);
}

}  // namespace

UnitTable::UnitTable(const Table& table) {
  for (const TableRow& row : table.rows()) Add(row);
}

void UnitTable::Add(const TableRow& row) {
  const std::string& key = row.key();
  if (fields_.size() + effects_.size() + rules_.size() >= kMostRows) {
    row.Fail("more rows than are read (" + std::to_string(kMostRows) + ")");
  }
  const auto effect = std::ranges::find(kEffectRows, key, &EffectRow::key);
  const auto rule = std::ranges::find(kRuleRows, key, &RuleRow::key);
  if (key == "field") {
    fields_.push_back(ReadField(row));
  } else if (effect != kEffectRows.end()) {
    const auto [unused, first, second] = *effect;
    effects_.push_back({static_cast<Effect::Kind>(effect - kEffectRows.begin()), ReadUnit(row, 1),
                        row.Within(2, -first, first),
                        second > 0 ? row.Within(3, -second, second) : 0});
    row.EndsAt(second > 0 ? 4 : 3);
  } else if (rule != kRuleRows.end()) {
    rules_.push_back({static_cast<Rule::Kind>(rule - kRuleRows.begin()), ReadUnit(row, 1),
                      ReadUnit(row, 2), rule->has_part ? row.Within(3, 0, 1) : 0});
    row.EndsAt(rule->has_part ? 4 : 3);
  } else {
    row.Fail("unknown word '" + key + "'");
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
    static constexpr std::array<const char*, 3> kParts{" above", " below", " both"};
    row("field", {number(field.unit), field.at.x, field.at.y, field.radius.x, field.radius.y});
    text += kParts[static_cast<std::size_t>(field.lip)];
    for (int k = 0; k < 3; ++k) text += Digits(field.by[k]);
  }
  for (const Effect& effect : effects_) {
    const EffectRow& kind = kEffectRows[static_cast<std::size_t>(effect.kind)];
    row(kind.key, {number(effect.unit), effect.first});
    if (kind.most_second > 0) text += Digits(effect.second);
  }
  for (const Rule& rule : rules_) {
    const RuleRow& kind = kRuleRows[static_cast<std::size_t>(rule.kind)];
    row(kind.key, {number(rule.a), number(rule.b)});
    if (kind.has_part) text += Digits(rule.part);
  }
  return text;
}

void UnitTable::MakeAsymmetric(int seed) {
  for (std::size_t unit = 1; unit < kActionUnits; ++unit) {
    if (unit >= kLidDroop || unit == kJawDrop || unit == kMouthStretch) continue;
    const float lean = kMostLean * NoiseAt(static_cast<int>(unit), 90 + seed);
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
  Sided<UnitValues> units;
  const float shown =
      std::isfinite(state.asymmetry) ? std::clamp(state.asymmetry, 0.0f, kMostAsymmetry) : 0;
  for (const Side side : kSides) {
    for (std::size_t i = 1; i < state.au[side].size(); ++i) {
      const float acting = Acting(state.au[side][i]);
      const float lean = std::as_const(lean_[side])[i];
      if (acting > 0) units[side][i] = (1 + shown * lean) * acting;
    }
  }
  for (UnitValues* const side : {&units.right, &units.left}) {
    UnitValues& acting = *side;
    const auto before = acting;  // rules read what was asked, so their order does not matter
    for (const Rule& rule : rules_) {
      const float a = before[At(rule.a)];
      const float b = before[At(rule.b)];
      if (rule.kind == Rule::Kind::kDamp) {
        acting[At(rule.a)] *= 1 - rule.part * std::min(b, 1.0f);
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
  return units;
}

UnitEffects UnitTable::Effects(const Sided<UnitValues>& units) const {
  UnitEffects sum;
  for (const Effect& effect : effects_) {
    const float right = units.right[At(effect.unit)];
    const float left = units.left[At(effect.unit)];
    const float either = std::max(left, right);
    switch (effect.kind) {
      case Effect::Kind::kLid:
        for (const Side s : kSides) {
          sum.lids[s].upper_mm += effect.first * units[s][At(effect.unit)];
          sum.lids[s].lower_mm += effect.second * units[s][At(effect.unit)];
        }
        break;
      case Effect::Kind::kClose:
        for (const Side s : kSides) {
          sum.lids[s].close = std::max(sum.lids[s].close, effect.first * units[s][At(effect.unit)]);
        }
        break;
      case Effect::Kind::kJaw:
        sum.jaw_degrees += effect.first * either;
        sum.jaw_slide_mm += effect.second * either;
        break;
      case Effect::Kind::kSway:
        sum.jaw_sway_mm += effect.first * (left - right);
        break;
      case Effect::Kind::kSeal:
        sum.seal = std::max(sum.seal, effect.first * either);
        break;
      case Effect::Kind::kTongue:
        sum.tongue_raise += effect.first * either;
        sum.tongue_out_mm += effect.second * either;
        break;
    }
  }
  return sum;
}

glm::vec3 UnitTable::FieldDisplacement(const Field& field, const SkinWeights& weights, Side side) {
  const float x = SignOf(side) * weights.domain.x;
  if (std::abs(weights.domain.y - field.at.y) >= field.radius.y) return glm::vec3(0);
  // Both sides act at the median, half each, so that left and right add up to the whole.
  const float own_side = LeftShareAt(x);
  if (own_side <= 0) return glm::vec3(0);
  float weight = 0;
  // A field that reaches over the median overlaps its mirror image; the stronger one counts.
  for (const float image : {1.0f, -1.0f}) {
    const float dx = (x - image * field.at.x) / field.radius.x;
    const float dy = (weights.domain.y - field.at.y) / field.radius.y;
    const float d2 = dx * dx + dy * dy;
    if (d2 < 1) weight = std::max(weight, (1 - d2) * (1 - d2));
  }
  using Lip = Field::Lip;
  if (field.lip == Lip::kUpper) weight *= weights.above_mouth;
  if (field.lip == Lip::kLower) weight *= 1 - weights.above_mouth;
  weight *= own_side * weights.free;
  glm::vec3 by = field.by;
  // The sideways component changes sign smoothly at the median, so that the skin does not tear.
  by.x *= std::clamp(x / kSidewaysMeetMm, -1.0f, 1.0f) * SignOf(side);
  return weight * by;
}

float LeftShareAt(float x_mm) { return SmoothStep(-7, 7, x_mm); }

Creases CreaseDepths(const Sided<UnitValues>& units,
                     const std::array<float, kLastingCreases>& at_rest) {
  /// How much depth a unit at full strength adds to a crease. The numbers are ours, judged by eye.
  struct Share {
    Crease crease;
    ActionUnit unit;
    float depth;
  };
  static constexpr Share kShares[] = {{Crease::kForehead, kInnerBrowRaiser, 0.6f},
                                      {Crease::kForehead, kOuterBrowRaiser, 0.6f},
                                      {Crease::kGlabella, kBrowLowerer, 0.7f},
                                      {Crease::kGlabella, kNoseWrinkler, 0.3f},
                                      {Crease::kNose, kNoseWrinkler, 0.9f},
                                      {Crease::kNose, kLipCornerPuller, 0.15f},
                                      {Crease::kCrowsFeet, kCheekRaiser, 0.6f},
                                      {Crease::kCrowsFeet, kLipCornerPuller, 0.42f},
                                      {Crease::kNasolabial, kUpperLipRaiser, 0.4f},
                                      {Crease::kNasolabial, kNasolabialDeepener, 0.4f},
                                      {Crease::kNasolabial, kNoseWrinkler, 0.4f},
                                      {Crease::kNasolabial, kLipCornerPuller, 0.75f}};
  Creases creases{};
  for (const Side side : kSides) {
    for (std::size_t k = 0; k < kLastingCreases; ++k) creases[k][side] = at_rest[k];
    for (const auto& [crease, unit, depth] : kShares) {
      creases[static_cast<std::size_t>(crease)][side] += depth * units[side][unit];
    }
    for (Sided<float>& depth : creases) depth[side] = std::clamp(depth[side], 0.0f, 1.0f);
  }
  return creases;
}

}  // namespace fsm
