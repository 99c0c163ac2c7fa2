#pragma once

#include <charconv>
#include <string>
#include <string_view>

namespace am {

/// The tags of the hub's own requests: a letter that tells whose they are, and a number above 0.
inline std::string FormatTag(char letter, unsigned long number) {
  return letter + std::to_string(number);
}
/// 0 for a tag that is not of this kind.
inline unsigned long NumberOfTag(char letter, std::string_view tag) {
  unsigned long number = 0;
  if (tag.starts_with(letter)) std::from_chars(tag.data() + 1, tag.data() + tag.size(), number);
  return number;
}

}  // namespace am
