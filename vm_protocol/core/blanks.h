#pragma once

#include <string_view>

namespace vm {

/// What stands between the words of a line.
inline constexpr std::string_view kBlanks = " \t\r";

/// What stands between the words of a value.
constexpr bool IsBlank(char c) { return c == ' ' || c == '\t'; }

/// The text without `blanks` at either end. Lifetime: of `text`.
constexpr std::string_view Trimmed(std::string_view text, std::string_view blanks = kBlanks) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace vm
