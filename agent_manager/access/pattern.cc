#include "agent_manager/access/pattern.h"

#include "vm_protocol/core/lower_case.h"

namespace am {
namespace {

template <typename Same>
bool Matches(std::string_view pattern, std::string_view text, const Same& same) {
  // The last star may always take one character more: no need to go back further.
  std::size_t p = 0, t = 0, star = std::string_view::npos, after_star = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = t;
    } else if (p < pattern.size() && same(pattern[p], text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++after_star;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace

bool MatchesPattern(std::string_view pattern, std::string_view text) {
  return Matches(pattern, text, [](char a, char b) { return a == b; });
}

bool MatchesIgnoringCase(std::string_view pattern, std::string_view text) {
  return Matches(pattern, text,
                 [](char a, char b) { return vm::LowerCase(a) == vm::LowerCase(b); });
}

}  // namespace am
