#pragma once

#include <string>
#include <string_view>

namespace vm {

/// The text with Latin capitals made small; all other bytes stay as they are.
inline std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

}  // namespace vm
