#include "gateway/face/mouth_numbers.h"

#include <algorithm>

namespace gateway {

std::optional<std::size_t> MouthNumberOf(std::string_view word) {
  const auto found = std::ranges::find(kMouthNumbers, word);
  if (found == kMouthNumbers.end()) return {};
  return static_cast<std::size_t>(found - kMouthNumbers.begin());
}

std::array<float, kMouthNumbers.size()> MouthNumbers(
    const std::array<float, vdm::kMouthParameters>& mouth, float seal, float tongue) {
  std::array<float, kMouthNumbers.size()> numbers{};
  std::ranges::copy(mouth, numbers.begin());
  numbers[kUpperInnerY] *= 1 - seal;
  numbers[kLowerInnerY] *= 1 - seal;
  numbers[vdm::kMouthParameters] = seal;
  numbers[vdm::kMouthParameters + 1] = tongue;
  numbers[vdm::kMouthParameters + 2] = seal * mouth[kJaw];
  return numbers;
}

}  // namespace gateway
