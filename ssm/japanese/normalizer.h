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
///   numbers            1,234  3.14  -5  ３　(wide digits, commas and points)
///   units written out  1万2千  1.5億  3千万
///   with counters      3本  15日  午後2時; behind decimals a counter does not change: 1.5人
///   fractions          3分の2  1/2個 (without a counter it is a date)
///   leading zeros      05分 (two digits and a counter) as 5分, else digit by digit
///   dates and times    2026/11/21  2026-11-21  2026.11.21  11/21  14:30  14:30:05
///   several points     192.168.0.1  1.2.3
///   telephone numbers  03-1234-5678 (two hyphens or a leading zero: digit by digit)
///   money, letters     ¥500  $20  AB (letter names), ~ between numbers (から)
/// Digit by digit are also numbers of more than kMostNumberDigits digits, and of more than 15 that
/// have neither commas nor a unit nor a counter: those of cards and accounts.
/// A minus sign joins letters and katakana (F-16); elsewhere it makes a number negative.
/// Everything else is handed on as it is. Pure.
std::vector<JapanesePart> NormalizeJapanese(std::string_view text, const Counters& counters);

}  // namespace ssm
