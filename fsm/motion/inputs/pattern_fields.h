#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/table_reader.h"

namespace fsm {

/// A number of a line in motions.txt and the member that stores it.
template <typename Pattern>
struct PatternField {
  std::string_view name;
  double Pattern::*place;
  double min = 0;
};

/// Checks that the pattern number of a line KIND PATTERN ... is `have` + 1. Throws TableError.
inline void CheckNextPattern(const TableRow& row, std::size_t have) {
  const double pattern = row.Within<double>(1, 1, 10000, "a pattern number");
  if (pattern != static_cast<double>(have + 1)) {
    row.Refuse(fmt::format("pattern {:g} found, {} expected next", pattern, have + 1));
  }
}

/// Reads a line KIND PATTERN NUMBER ..., with one number for each field. Throws TableError.
template <typename Pattern, std::size_t kCount>
void ReadPatternFields(const TableRow& row, std::vector<Pattern>& patterns,
                       const std::array<PatternField<Pattern>, kCount>& fields) {
  CheckNextPattern(row, patterns.size());
  if (row.size() != kCount + 2) {
    std::string names;
    for (const auto& field : fields) names += " " + std::string(field.name);
    row.Refuse(row.key() + " PATTERN" + names + " expected");
  }
  constexpr double kMax = 3'600'000;
  Pattern& pattern = patterns.emplace_back();
  for (std::size_t i = 0; i < kCount; ++i) {
    pattern.*fields[i].place = row.Within<double>(2 + i, fields[i].min, kMax, fields[i].name);
  }
}

}  // namespace fsm
