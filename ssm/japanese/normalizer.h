#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ssm/japanese/numbers.h"

namespace ssm {

/// A part of a Japanese text.
struct JapanesePart {
  std::string text{};     ///< as written
  std::string reading{};  ///< katakana; empty = to be found by a dictionary
  bool operator==(const JapanesePart&) const = default;
};

/// Takes from a Japanese text what a dictionary of words cannot read and gives its reading:
///   numbers            1,234  3.14  -5  ３　(wide digits)  1万2千 (units written out)
///   with counters      3本  15日  午後2時
///   dates and times    2026/11/21  2026-11-21  11/21  14:30  14:30:05
///   telephone numbers  03-1234-5678 (two hyphens or a leading zero: digit by digit)
///   money, letters     ¥500  $20  AB (letter names), ~ between numbers (から)
/// Everything else is handed on as it is. Pure.
std::vector<JapanesePart> NormalizeJapanese(std::string_view text, const Counters& counters);

}  // namespace ssm
