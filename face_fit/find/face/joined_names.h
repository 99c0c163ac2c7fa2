#pragma once

#include <initializer_list>
#include <string>
#include <utility>

namespace facefit {

/// Returns the names that are marked true.
inline std::string JoinedNames(std::initializer_list<std::pair<bool, const char*>> parts,
                               const char* separator = ", ") {
  std::string names;
  for (const auto& [named, name] : parts) {
    if (named) names += (names.empty() ? "" : separator) + std::string(name);
  }
  return names;
}

}  // namespace facefit
