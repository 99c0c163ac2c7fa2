#include "ssm/japanese/numbers.h"

#include <array>
#include <sstream>
#include <utility>

namespace ssm {
namespace {

constexpr std::array<const char*, 10> kDigits = {"ゼロ", "イチ", "ニ",   "サン", "ヨン",
                                                 "ゴ",   "ロク", "ナナ", "ハチ", "キュー"};
constexpr std::size_t kKana = 3;  // bytes of one kana

std::string Thousands(std::uint64_t number) {  // 1 to 9999
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

}  // namespace

std::string ReadNumber(std::uint64_t number) {
  if (number == 0) return kDigits[0];
  static constexpr std::array<const char*, 4> kUnits = {"", "マン", "オク", "チョー"};
  std::string text;
  for (std::size_t i = 4; i-- > 0;) {
    std::uint64_t scale = 1;
    for (std::size_t k = 0; k < i; ++k) scale *= 10'000;
    const std::uint64_t part = number / scale % 10'000;
    if (part == 0) continue;
    std::string read = Thousands(part);
    if (i == 3 && part % 10 == 1 && part % 100 != 11) {  // 一兆 is イッチョー
      read.replace(read.size() - kKana, kKana, "ッ");
    }
    text += read + kUnits[i];
  }
  return text;
}

std::string ReadDigits(std::string_view digits) {
  std::string text;
  for (const char c : digits) {
    if (c >= '0' && c <= '9') text += kDigits[static_cast<std::size_t>(c - '0')];
  }
  return text;
}

std::string LetterName(char letter) {
  static constexpr std::array<const char*, 26> kNames = {
      "エー",   "ビー",   "シー", "ディー", "イー",       "エフ",     "ジー", "エイチ", "アイ",
      "ジェー", "ケー",   "エル", "エム",   "エヌ",       "オー",     "ピー", "キュー", "アール",
      "エス",   "ティー", "ユー", "ブイ",   "ダブリュー", "エックス", "ワイ", "ゼット"};
  const char upper =
      letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  return upper >= 'A' && upper <= 'Z' ? kNames[static_cast<std::size_t>(upper - 'A')] : "";
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

std::string Counters::Read(std::uint64_t number, std::string_view name) const {
  const Counter& counter = counters_.find(name)->second;
  const auto& readings = counter.readings;
  if (const auto whole = readings.find(std::to_string(number) + "!"); whole != readings.end()) {
    return whole->second;
  }
  const auto before = [](std::uint64_t rest) { return rest == 0 ? "" : ReadNumber(rest); };
  const auto entry = [&](const char* key) {
    const auto found = readings.find(key);
    return found == readings.end() ? std::string() : found->second;
  };
  if (const auto digit = number % 10; digit != 0) {
    const std::string read = entry(std::to_string(digit).c_str());
    if (!read.empty()) return before(number - digit) + read;
  } else if (const auto tens = number / 10 % 10; tens != 0) {
    const std::string read = entry("10");
    const std::string hundreds = before(number - tens * 10);
    if (!read.empty()) return hundreds + (tens == 1 ? "" : ReadNumber(tens)) + read;
  } else if (number / 100 % 10 != 0) {
    const std::string read = entry("100");
    std::string hundreds = ReadNumber(number);
    if (!read.empty()) return hundreds.erase(hundreds.size() - kKana) + read;
  } else if (number != 0) {
    const std::string read = entry("1000");
    if (!read.empty()) return ReadNumber(number) + read;
  }
  return ReadNumber(number) + counter.kana;
}

}  // namespace ssm
