#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace gateway {

/// Weights from 0 to 1 as sums of a face's numbers, read from a table whose lines are NAME
/// NUMBER:FACTOR .... A plain value.
struct WeightSums {
  using Sum = std::vector<std::pair<std::size_t, float>>;  // which number, and its factor
  std::vector<std::string> names{};
  std::vector<Sum> sums{};  ///< beside the names

  /// `number_of` says which number a word names. kBadValue "NAME:LINE: ..." for a word that names
  /// none, a factor that is none, and a name that is there twice.
  static vm::Result<WeightSums> Read(
      const std::string& table, std::string_view text,
      const std::function<std::optional<std::size_t>(std::string_view word)>& number_of);
  std::vector<float> Of(std::span<const float> numbers) const;
};

}  // namespace gateway
