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
void VisitNumbers(CloseEffect& close, const auto& v) { v(close.share, 1); }
void VisitNumbers(JawEffect& jaw, const auto& v) { v(jaw.degrees, 60), v(jaw.slide_mm, 30); }
void VisitNumbers(SwayEffect& sway, const auto& v) { v(sway.mm, 30); }
void VisitNumbers(SealEffect& seal, const auto& v) { v(seal.share, 1); }
void VisitNumbers(TongueEffect& tongue, const auto& v) { v(tongue.raise, 1), v(tongue.out_mm, 60); }
void VisitNumbers(CreaseEffect& crease, const auto& v) {
  for (float& depth : crease.depth) v(depth, 1);
}

template <typename Effect>
UnitEffect ReadEffect(const TableRow& row) {
  Effect effect{};
  std::size_t index = 2;
  VisitNumbers(effect, [&](float& n, float limit) {
    // Rows without the last number of a crease crease the whole forehead alike.
    const bool left_out =
        std::is_same_v<Effect, CreaseEffect> && index == row.size() && index == 1 + kCreases;
    n = left_out ? row.Within(2, -limit, limit) : row.Within(index++, -limit, limit);
  });
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

std::vector<int> UnitTable::Numbers() const {
  std::set<int> numbers;
  for (const Field& field : fields_) numbers.insert(field.unit);
  for (const Effect& effect : effects_) numbers.insert(effect.unit);
  return {numbers.begin(), numbers.end()};
}

}  // namespace fsm
