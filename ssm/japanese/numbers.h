#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace ssm {

/// A whole number in katakana: 15 ジューゴ, 3600 サンゼンロッピャク. REQUIRES: below 10^16.
std::string ReadNumber(std::uint64_t number);
/// Digit by digit: 03 ゼロサン. Other characters are dropped.
std::string ReadDigits(std::string_view digits);
/// A Latin letter's name: A エー; empty for anything else.
std::string LetterName(char letter);

/// Counters and how numbers sound before them, from a table (ssm/tables/ja_counters.txt):
///     COUNTER KANA [N=READING...]
/// N from 1 to 9: the last digit and the counter together (本 1=イッポン). 10: the last ten.
/// 100: what takes the place of the last kana of a number in hundreds; 1000: what comes behind
/// thousands. N! is the whole number only (人 1!=ヒトリ). Where there is no entry: number, KANA.
class Counters {
 public:
  /// Errors: kSyntax, "FILE:LINE: ...".
  static vm::Result<Counters> Parse(std::string_view table, const std::string& file);
  /// The longest counter at the beginning of `text`; empty = none.
  std::string_view Find(std::string_view text) const;
  /// REQUIRES: `counter` came from Find; number below 10^16.
  std::string Read(std::uint64_t number, std::string_view counter) const;

 private:
  struct Counter {
    std::string kana;
    std::map<std::string, std::string, std::less<>> readings;
  };
  std::map<std::string, Counter, std::less<>> counters_;
};

}  // namespace ssm
