#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "embedded/feature_numbers.h"
#include "fsm/base/number_table.h"
#include "fsm/base/spline.h"

namespace fsm {

/// What eyeballs, teeth, tongue, ears, lashes, brows, hair, shirt and skin are like:
/// tables/features.txt, where each number is explained. Constant after construction; thread: any.
class Features : public FeatureNumbers {
 public:
  /// In place of the built-in table. Throws as NumberTable, and if the x of a curve do not ascend
  /// or a number is beyond its limits.
  Features(const std::string& file, std::string_view text)
      : Features(NumberTable(file, text, &BuiltIn().table_)) {}
  static const Features& BuiltIn();
  const NumberTable& table() const { return table_; }

 private:
  explicit Features(NumberTable numbers);

  NumberTable table_;
};

/// Of a row that is a list of x and y.
std::vector<glm::vec2> PairsOf(std::span<const float> row);
Curve CurveOf(std::span<const float> row);

}  // namespace fsm
