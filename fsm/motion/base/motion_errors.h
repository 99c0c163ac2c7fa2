#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <string_view>
#include <vector>

#include "fsm/rig/unit_values.h"
#include "vm_protocol/core/result.h"

/// Checks and error texts that the commands of FaceMotion share.
namespace fsm {

/// Returns the keys of a map, separated by blanks.
template <typename Map>
std::string KeysOf(const Map& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return fmt::format("{}", fmt::join(keys, " "));
}

inline vm::Result<void> CheckPatternNumber(std::string_view kind, int pattern, int min,
                                           std::size_t count) {
  if (pattern >= min && pattern <= static_cast<int>(count)) return {};
  if (count == 0) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("there is no pattern of {}", kind));
  }
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{} has no pattern {}; {} to {} expected", kind,
                                                   pattern, min, count));
}

/// Checks that a strength is within 0..kMaxStrength.
inline vm::Result<void> CheckStrength(double strength) {
  if (strength >= 0 && strength <= kMaxStrength) return {};
  return vm::Fail(
      vm::Errc::kBadValue,
      fmt::format("{:g} is no strength; 0 to {:g} expected, 1 = full", strength, kMaxStrength));
}

}  // namespace fsm
