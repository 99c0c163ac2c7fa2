#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace facefit {

/// Returns the median; of an even number of values the upper middle one. REQUIRES: at least one
/// value.
inline float Median(std::vector<float> values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace facefit
