#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace ssm {

/// The primary language of a tag, in lower case: "en-GB" -> "en", "JA" -> "ja".
inline std::string PrimaryLanguage(std::string_view tag) {
  std::string primary(tag.substr(0, tag.find_first_of("-_")));
  std::ranges::transform(primary, primary.begin(), [](char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  });
  return primary;
}

}  // namespace ssm
