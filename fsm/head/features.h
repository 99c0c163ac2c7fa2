#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "embedded/feature_numbers.h"
#include "fsm/base/number_table.h"
#include "fsm/base/spline.h"

namespace fsm {

/// The look of eyeballs, teeth, tongue, ears, lashes, brows, hair, shirt and skin, read from
/// tables/features.txt, which explains each number. Constant after construction; thread: any.
class Features : public FeatureNumbers {
 public:
  /// Reads a table that overrides the built-in one. Throws as NumberTable does, and if the x of a
  /// curve do not ascend or a number exceeds its limits.
  Features(const std::string& file, std::string_view text)
      : Features(NumberTable(file, text, &BuiltIn()->table_)) {}
  /// Never null.
  static const std::shared_ptr<const Features>& BuiltIn();
  const NumberTable& table() const { return table_; }

 private:
  explicit Features(NumberTable numbers);

  NumberTable table_;
};

/// Read a row that is a list of pairs x y.
std::vector<glm::vec2> PairsOf(std::span<const float> row);
Curve CurveOf(std::span<const float> row);

}  // namespace fsm
