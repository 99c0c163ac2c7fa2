#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace ssm {

/// Numbers are given as their ASCII digits, so that none is too large; leading zeros do not count.
/// Those of more digits than this (10^24 and above) are read digit by digit.
inline constexpr std::size_t kMostNumberDigits = 24;

/// A whole number in katakana: 15 ジューゴ, 3600 サンゼンロッピャク, 10^16 イッケイ.
std::string ReadNumber(std::string_view digits);
/// What stands before a point, with the point: 1 イッテン, 0 レイテン, 12 ジューニーテン.
std::string ReadPoint(std::string_view digits);
/// 1.5: ReadPoint of what is before the point, and the digits behind it one by one.
std::string ReadDecimal(std::string_view whole, std::string_view decimals);
/// Digit by digit: 03 ゼロサン. Other characters are dropped.
std::string ReadDigits(std::string_view digits);
/// A Latin letter's name: A エー; empty for anything else.
std::string LetterName(char letter);

/// Counters and how numbers sound before them, from a table (ssm/tables/ja_counters.txt):
///     COUNTER KANA [N=READING...]
/// N from 1 to 9: the last digit and the counter together (本 1=イッポン). 10: the last ten.
/// 100: what takes the place of the last kana of a number in hundreds; 1000: what comes behind
/// thousands and ten thousands. N! is the whole number only (人 1!=ヒトリ). Where there is no
/// entry: number, KANA.
class Counters {
 public:
  /// Errors: kSyntax, "FILE:LINE: ...".
  static vm::Result<Counters> Parse(std::string_view table, const std::string& file);
  /// The longest counter at the beginning of `text`; empty = none.
  std::string_view Find(std::string_view text) const;
  /// A whole number and its counter. REQUIRES: `counter` came from Find.
  std::string Read(std::string_view digits, std::string_view counter) const;
  /// The counter as it sounds behind a decimal or a fraction, which never change it.
  /// REQUIRES: `counter` came from Find.
  const std::string& Kana(std::string_view counter) const;

 private:
  struct Counter {
    std::string kana;
    std::map<std::string, std::string, std::less<>> readings;
  };
  std::map<std::string, Counter, std::less<>> counters_;
};

}  // namespace ssm
