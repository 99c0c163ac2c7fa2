#include "fsm/motion/inputs/expression_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fsm/base/range.h"
#include "fsm/base/table_reader.h"

namespace fsm {
namespace {

void ReadTiming(const TableRow& row, ExpressionTable& expressions) {
  if (row.size() != 6) row.Refuse(row.key() + " NAME ONSET EYE BROW MOUTH expected");
  Expression& expression = expressions[row.Name(1, "an emotion's name")];
  Expression::Timing& timing = row.key() == "posed" ? expression.posed : expression.elicited;
  timing.onset_ms = row.Within<double>(2, 0, 10000, "an onset in ms");
  for (std::size_t i = 0; i < kRegions; ++i) {
    timing.lag_ms[i] = row.Within<double>(3 + i, 0, 1000, "a lag in ms");
  }
}

void ReadPattern(const TableRow& row, const UnitNames& names, ExpressionTable& expressions) {
  const double pattern = row.Within<double>(1, 1, 100, "a pattern number");
  auto& patterns = expressions[row.Name(0, "an emotion's name")].patterns;
  if (pattern != static_cast<double>(patterns.size() + 1)) {
    row.Refuse(fmt::format("pattern {:g} found, {} expected next", pattern, patterns.size() + 1));
  }
  patterns.push_back(ReadLook(row, 2, names));
}

/// Reads a row that gives units of a pattern above it a number each, into the pattern's place in
/// `looks`. `expected`: what the numbers are, for the error where one is outside `allowed`.
void ReadNumbers(const TableRow& row, const UnitNames& names, ExpressionTable& expressions,
                 std::vector<FaceLook> Expression::*looks, Range allowed,
                 const std::string& expected) {
  Expression& expression = expressions[row.Name(1, "an emotion's name")];
  const auto pattern = static_cast<std::size_t>(row.Within<double>(2, 1, 100, "a pattern number"));
  if (pattern > expression.patterns.size()) row.Refuse("a pattern that stands above expected");
  FaceLook look = ReadLook(row, 3, names);
  for (const Side side : kSides) {
    for (const float number : look.au[side]) {
      if (number != 0 && !allowed.Contains(number)) row.Refuse(expected + " expected");
    }
    if (look.gaze[side] != EyeAngles{}) row.Refuse("action units expected, and no gaze");
  }
  (expression.*looks).resize(expression.patterns.size());
  (expression.*looks)[pattern - 1] = std::move(look);
}

}  // namespace

void Expression::Redefine(std::size_t pattern, const FaceLook& look) {
  patterns.resize(std::max(patterns.size(), pattern));
  patterns[pattern - 1] = look;
  if (pattern <= begins.size()) begins[pattern - 1] = {};
  if (pattern <= early.size()) early[pattern - 1] = {};
}

FaceLook Expression::LookOf(int pattern, double strength) const {
  const auto index = static_cast<std::size_t>(pattern - 1);
  FaceLook look;
  AddTo(look, patterns[index], strength);
  const auto number_of = [&](const std::vector<FaceLook>& looks, Side side, std::size_t unit) {
    return index < looks.size() ? looks[index].au[side][unit] : 0.0F;
  };
  for (const Side side : kSides) {
    for (std::size_t unit = 0; unit < look.au[side].size(); ++unit) {
      const double from = number_of(begins, side, unit), power = number_of(early, side, unit);
      if (from == 0 && power == 0) continue;
      double share = std::max(0.0, strength - from) / (1 - from);
      if (power != 0 && share < 1) share = std::pow(share, power);
      look.au[side][unit] = patterns[index].au[side][unit] * static_cast<float>(share);
    }
  }
  return look;
}

vm::Result<ExpressionTable> ReadExpressions(const std::string& name, std::string_view text,
                                            const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    ExpressionTable expressions;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "posed" || row.key() == "elicited") {
        ReadTiming(row, expressions);
      } else if (row.key() == "begins") {
        ReadNumbers(row, names, expressions, &Expression::begins, {0, 0.9f},
                    "strengths from 0 to 0.9");
      } else if (row.key() == "early") {
        ReadNumbers(row, names, expressions, &Expression::early, {0.3f, 1}, "powers from 0.3 to 1");
      } else {
        ReadPattern(row, names, expressions);
      }
    }
    for (const auto& [word, expression] : expressions) {
      if (expression.patterns.empty()) table.Refuse("'" + word + "' has no pattern 1");
    }
    return expressions;
  });
}

}  // namespace fsm
