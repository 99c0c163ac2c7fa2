#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace am {

/// `*` in the pattern stands for any text, also none. Case counts.
bool MatchesPattern(std::string_view pattern, std::string_view text);
/// The same, with the letters A to Z as a to z.
bool MatchesIgnoringCase(std::string_view pattern, std::string_view text);

inline bool AnyMatches(const std::vector<std::string>& patterns, std::string_view text) {
  for (const std::string& pattern : patterns) {
    if (pattern == "*" || MatchesPattern(pattern, text)) return true;
  }
  return false;
}

}  // namespace am
