#include "ssm/japanese/numbers.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

namespace ssm {
namespace {

constexpr std::array<const char*, 10> kDigits = {"ゼロ", "イチ", "ニ",   "サン", "ヨン",
                                                 "ゴ",   "ロク", "ナナ", "ハチ", "キュー"};
constexpr std::size_t kKana = 3;  // bytes of one kana

/// A unit of ten thousands, and which numbers before it lose their last kana to a ッ: those that
/// end in one of `digits`, in tens, in hundreds.
struct Myriad {
  const char* kana;
  std::string_view digits;
  bool tens, hundreds;
};
constexpr std::array<Myriad, 6> kMyriads = {{{"", "", false, false},
                                             {"マン", "", false, false},
                                             {"オク", "", false, false},
                                             {"チョー", "18", true, false},
                                             {"ケイ", "168", true, true},
                                             {"ガイ", "", false, false}}};
static_assert(kMyriads.size() * 4 == kMostNumberDigits);

/// Without the zeros before it; of a zero nothing is left.
std::string_view Trimmed(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

/// イチ becomes イッ, ジュー ジュッ, ヒャク ヒャッ.
void Shorten(std::string& read) { read.replace(read.size() - kKana, kKana, "ッ"); }

std::string Thousands(std::size_t number) {  // 1 to 9999
  std::string text;
  if (const auto digit = number / 1000) {
    text += digit == 1   ? "セン"
            : digit == 3 ? "サンゼン"
            : digit == 8 ? "ハッセン"
                         : kDigits[digit] + std::string("セン");
  }
  if (const auto digit = number / 100 % 10) {
    text += digit == 1   ? "ヒャク"
            : digit == 3 ? "サンビャク"
            : digit == 6 ? "ロッピャク"
            : digit == 8 ? "ハッピャク"
                         : kDigits[digit] + std::string("ヒャク");
  }
  if (const auto digit = number / 10 % 10)
    text += digit == 1 ? "ジュー" : kDigits[digit] + std::string("ジュー");
  if (const auto digit = number % 10) text += kDigits[digit];
  return text;
}

/// The digit of a number that is so many places from its end.
char DigitAt(std::string_view number, std::size_t from_end) {
  return from_end < number.size() ? number[number.size() - 1 - from_end] : '0';
}

}  // namespace

std::string ReadNumber(std::string_view digits) {
  const std::string_view number = Trimmed(digits);
  if (number.empty()) return kDigits[0];
  if (number.size() > kMostNumberDigits) return ReadDigits(digits);
  std::string text;
  for (std::size_t i = kMyriads.size(); i-- > 0;) {
    std::size_t part = 0;
    for (std::size_t k = 4; k-- > 0;) {
      part = 10 * part + static_cast<std::size_t>(DigitAt(number, 4 * i + k) - '0');
    }
    if (part == 0) continue;
    const Myriad& unit = kMyriads[i];
    std::string read = Thousands(part);
    const bool shortened = part % 10 != 0    ? unit.digits.contains(DigitAt(number, 4 * i))
                           : part % 100 != 0 ? unit.tens
                                             : unit.hundreds && part % 1000 != 0;
    if (shortened) Shorten(read);
    text += read + unit.kana;
  }
  return text;
}

std::string ReadPoint(std::string_view digits) {
  const std::string_view number = Trimmed(digits);
  if (number.empty()) return "レイテン";
  std::string read = ReadNumber(digits);
  const char last = DigitAt(number, 0);
  if (number.size() > kMostNumberDigits) return read + "テン";
  if (last == '1' || last == '8' || (last == '0' && DigitAt(number, 1) != '0')) {
    Shorten(read);
  } else if (last == '2' || last == '5') {
    read += "ー";
  }
  return read + "テン";
}

std::string ReadDecimal(std::string_view whole, std::string_view decimals) {
  return ReadPoint(whole) + ReadDigits(decimals);
}

std::string ReadDigits(std::string_view digits) {
  std::string text;
  for (const char c : digits) {
    if (c >= '0' && c <= '9') text += kDigits[static_cast<std::size_t>(c - '0')];
  }
  return text;
}

std::string LetterName(char letter) {
  static constexpr std::array<const char*, 26> kLetterNames = {
      "エー",   "ビー",   "シー", "ディー", "イー",       "エフ",     "ジー", "エイチ", "アイ",
      "ジェー", "ケー",   "エル", "エム",   "エヌ",       "オー",     "ピー", "キュー", "アール",
      "エス",   "ティー", "ユー", "ブイ",   "ダブリュー", "エックス", "ワイ", "ゼット"};
  const char upper =
      letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  return upper >= 'A' && upper <= 'Z' ? kLetterNames[static_cast<std::size_t>(upper - 'A')] : "";
}

vm::Result<Counters> Counters::Parse(std::string_view table, const std::string& file) {
  Counters result;
  std::istringstream lines{std::string(table)};
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string name, reading;
    Counter counter;
    if (!(words >> name) || name.starts_with('#')) continue;
    const auto fail = [&](const std::string& what) {
      return vm::Fail(vm::Errc::kSyntax, file + ":" + std::to_string(number) + ": " + what);
    };
    if (!(words >> counter.kana)) return fail("expected COUNTER KANA [N=READING...]");
    while (words >> reading) {
      const std::size_t equal = reading.find('=');
      if (equal == 0 || equal == std::string::npos || equal + 1 == reading.size() ||
          reading.find_first_not_of("0123456789") + (reading[equal - 1] == '!' ? 1 : 0) != equal) {
        return fail("found '" + reading + "', expected N=READING or N!=READING");
      }
      counter.readings[reading.substr(0, equal)] = reading.substr(equal + 1);
    }
    if (!result.counters_.emplace(name, std::move(counter)).second) {
      return fail("'" + name + "' is there twice");
    }
  }
  return result;
}

std::string_view Counters::Find(std::string_view text) const {
  std::string_view longest;
  for (const auto& [name, counter] : counters_) {
    if (name.size() > longest.size() && text.starts_with(name)) longest = name;
  }
  return longest;
}

const std::string& Counters::Kana(std::string_view name) const {
  return counters_.find(name)->second.kana;
}

std::string Counters::Read(std::string_view digits, std::string_view name) const {
  const Counter& counter = counters_.find(name)->second;
  const auto& readings = counter.readings;
  const std::string_view number = Trimmed(digits);
  if (number.size() > kMostNumberDigits) return ReadDigits(digits) + counter.kana;
  const auto entry = [&](const std::string& key) {
    const auto found = readings.find(key);
    return found == readings.end() ? std::string() : found->second;
  };
  const std::string whole = entry((number.empty() ? "0" : std::string(number)) + "!");
  if (!whole.empty()) return whole;
  // The number without its last digits; nothing when there are no others.
  const auto before = [&](std::size_t last) {
    if (number.size() <= last) return std::string();
    return ReadNumber(std::string(number.substr(0, number.size() - last)) + std::string(last, '0'));
  };
  if (const char digit = DigitAt(number, 0); digit != '0') {
    const std::string read = entry(std::string(1, digit));
    if (!read.empty()) return before(1) + read;
  } else if (const char tens = DigitAt(number, 1); tens != '0') {
    const std::string read = entry("10");
    if (!read.empty()) {
      return before(2) + (tens == '1' ? "" : ReadNumber(std::string(1, tens))) + read;
    }
  } else if (DigitAt(number, 2) != '0') {
    const std::string read = entry("100");
    std::string hundreds = ReadNumber(number);
    if (!read.empty()) return hundreds.erase(hundreds.size() - kKana) + read;
  } else if (std::string read = ReadNumber(number); read.ends_with("ン")) {  // セン, マン
    const std::string behind = entry("1000");
    if (!behind.empty()) return read + behind;
  }
  return ReadNumber(number) + counter.kana;
}

}  // namespace ssm
