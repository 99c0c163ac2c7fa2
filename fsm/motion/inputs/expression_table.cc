#include "fsm/motion/inputs/expression_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

void ReadBegins(const TableRow& row, const UnitNames& names, ExpressionTable& expressions) {
  Expression& expression = expressions[row.Name(1, "an emotion's name")];
  const auto pattern = static_cast<std::size_t>(row.Within<double>(2, 1, 100, "a pattern number"));
  if (pattern > expression.patterns.size()) row.Refuse("a pattern that stands above expected");
  FaceLook begins = ReadLook(row, 3, names);
  for (const Side side : kSides) {
    for (const float from : begins.au[side]) {
      if (from > 0.9f) row.Refuse("strengths from 0 to 0.9 expected");
    }
    if (begins.gaze[side] != EyeAngles{}) row.Refuse("action units expected, and no gaze");
  }
  expression.begins.resize(expression.patterns.size());
  expression.begins[pattern - 1] = std::move(begins);
}

}  // namespace

void Expression::Redefine(std::size_t pattern, const FaceLook& look) {
  patterns.resize(std::max(patterns.size(), pattern));
  patterns[pattern - 1] = look;
  if (pattern <= begins.size()) begins[pattern - 1] = {};
}

FaceLook Expression::LookOf(int pattern, double strength) const {
  const auto index = static_cast<std::size_t>(pattern - 1);
  FaceLook look;
  AddTo(look, patterns[index], strength);
  if (index >= begins.size()) return look;
  for (const Side side : kSides) {
    for (std::size_t i = 0; i < begins[index].au[side].size(); ++i) {
      const double from = begins[index].au[side][i];
      if (from == 0) continue;
      look.au[side][i] = patterns[index].au[side][i] *
                         static_cast<float>(std::max(0.0, strength - from) / (1 - from));
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
        ReadBegins(row, names, expressions);
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
