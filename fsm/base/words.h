#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "vm_protocol/core/blanks.h"

namespace fsm {

/// Returns the first words of `line`, at most `max`; blanks separate them. Lifetime: of `line`.
inline std::vector<std::string_view> WordsOf(std::string_view line, std::size_t max = SIZE_MAX) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; words.size() < max;) {
    at = line.find_first_not_of(vm::kBlanks, at);
    if (at == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(vm::kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Removes from `text` its part before the first character of `endings`, and that character; or all
/// of it if there is none. Returns the removed part. Lifetime: of `text`.
inline std::string_view ReadUntil(std::string_view endings, std::string_view& text) {
  const std::string_view taken = text.substr(0, text.find_first_of(endings));
  text.remove_prefix(std::min(taken.size() + 1, text.size()));
  return taken;
}

}  // namespace fsm
