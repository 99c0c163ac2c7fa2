#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/number_table.h"
#include "fsm/base/spline.h"

namespace fsm {

/// What eyeballs, teeth, tongue, ears, lashes, brows, hair, shirt and skin are like:
/// tables/features.txt, where each number is explained. Constant after construction; thread: any.
class Features : public NumberTable {
 public:
  /// In place of the built-in table. Throws as NumberTable.
  Features(const std::string& file, std::string_view text)
      : Features(NumberTable(file, text, &BuiltIn())) {}
  static const Features& BuiltIn();

  /// REQUIRES: as NumberTable, pairs of numbers.
  std::vector<glm::vec2> Points(std::string_view name) const;
  Curve CurveOf(std::string_view name) const;  ///< of x and y

  // Rows of two numbers; REQUIRES as NumberTable.
  /// `part` of the way from the first to the second.
  float Between(std::string_view name, float part) const;
  /// SmoothStep from the first to the second.
  float Step(std::string_view name, float x) const;

 private:
  /// Throws if the x of a curve do not ascend, or there are no hairs where there must be some.
  explicit Features(NumberTable numbers);
};

}  // namespace fsm
