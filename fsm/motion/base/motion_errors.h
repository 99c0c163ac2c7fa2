#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <string_view>
#include <vector>

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

inline vm::Result<void> CheckPatternNumber(std::string_view kind, int pattern, int lowest,
                                           std::size_t count) {
  if (pattern >= lowest && pattern <= static_cast<int>(count)) return {};
  if (count == 0) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("there is no pattern of {}", kind));
  }
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{} has no pattern {}; {} to {} expected", kind,
                                                   pattern, lowest, count));
}

/// Checks that a strength is within 0..2.
inline vm::Result<void> CheckStrength(double strength) {
  if (strength >= 0 && strength <= 2) return {};
  return vm::Fail(vm::Errc::kBadValue,
                  fmt::format("{:g} is no strength; 0 to 2 expected, 1 = full", strength));
}

}  // namespace fsm
