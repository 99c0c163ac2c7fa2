#include "ssm/voice/spoken_forms.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <utility>
#include <vector>

#include "ssm/voice/span_builder.h"

namespace ssm {
namespace {

using Spoken = std::optional<std::string>;

constexpr std::array<std::string_view, 20> kSmall = {
    "zero",     "one",     "two",     "three",     "four",     "five",    "six",
    "seven",    "eight",   "nine",    "ten",       "eleven",   "twelve",  "thirteen",
    "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"};
constexpr std::array<std::string_view, 10> kTens = {
    "", "", "twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"};
constexpr std::array<std::pair<std::uint64_t, std::string_view>, 4> kGreat = {
    {{1'000'000'000'000, "trillion"},
     {1'000'000'000, "billion"},
     {1'000'000, "million"},
     {1'000, "thousand"}}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kOrdinals = {
    {{"one", "first"},
     {"two", "second"},
     {"three", "third"},
     {"five", "fifth"},
     {"eight", "eighth"},
     {"nine", "ninth"},
     {"twelve", "twelfth"}}};
constexpr std::array<std::string_view, 12> kMonths = {
    "January", "February", "March",     "April",   "May",      "June",
    "July",    "August",   "September", "October", "November", "December"};

struct Currency {
  std::string_view sign, code;
  std::string_view one, many, cent, cents, japanese;
};
constexpr std::array<Currency, 4> kCurrencies = {
    {{"$", "USD", "dollar", "dollars", "cent", "cents", "ドル"},
     {"€", "EUR", "euro", "euros", "cent", "cents", "ユーロ"},
     {"£", "GBP", "pound", "pounds", "penny", "pence", "ポンド"},
     {"¥", "JPY", "yen", "yen", "sen", "sen", "円"}}};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

std::string Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1));
}

/// A whole number, with commas between thousands or not.
std::optional<std::uint64_t> Whole(std::string_view text) {
  std::string digits(text);
  std::erase(digits, ',');
  if (digits.empty() || digits.size() > 15 || !std::ranges::all_of(digits, IsDigit)) return {};
  std::uint64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

void AddWord(std::string& text, std::string_view word) {
  if (!text.empty()) text += ' ';
  text += word;
}

std::string Cardinal(std::uint64_t number) {
  if (number < 20) return std::string(kSmall[number]);
  if (number < 100) {
    std::string text(kTens[number / 10]);
    if (number % 10 != 0) AddWord(text, kSmall[number % 10]);
    return text;
  }
  if (number < 1000) {
    std::string text = Cardinal(number / 100) + " hundred";
    if (number % 100 != 0) text += " and " + Cardinal(number % 100);
    return text;
  }
  for (const auto& [size, name] : kGreat) {
    if (number < size) continue;
    std::string text = Cardinal(number / size) + " " + std::string(name);
    const std::uint64_t rest = number % size;
    if (rest != 0) text += (rest < 100 ? " and " : " ") + Cardinal(rest);
    return text;
  }
  return "";
}

std::string Ordinal(std::uint64_t number) {
  std::string text = Cardinal(number);
  const std::size_t blank = text.rfind(' ');
  const std::size_t begin = blank == std::string::npos ? 0 : blank + 1;
  const std::string last = text.substr(begin);
  text.erase(begin);
  for (const auto& [cardinal, ordinal] : kOrdinals) {
    if (last == cardinal) return text + std::string(ordinal);
  }
  if (last.ends_with('y')) return text + last.substr(0, last.size() - 1) + "ieth";
  return text + last + "th";
}

/// 1984 in pairs, 2005 and 800 as numbers.
std::string Year(std::uint64_t year) {
  if (year < 1100 || year > 2099 || (year >= 2000 && year < 2010)) return Cardinal(year);
  if (year % 100 == 0) return Cardinal(year / 100) + " hundred";
  const std::string rest = year % 100 < 10 ? "oh " + Cardinal(year % 100) : Cardinal(year % 100);
  return Cardinal(year / 100) + " " + rest;
}

/// The numbers of a text; nothing but figures and single signs between them is allowed.
std::vector<std::uint64_t> NumbersOf(std::string_view text, std::string_view between) {
  std::vector<std::uint64_t> numbers;
  bool expected = true;
  for (std::size_t at = 0; at < text.size();) {
    if (!expected) {
      if (!between.contains(text[at])) return {};
      ++at;
    } else {
      std::size_t end = at;
      while (end < text.size() && IsDigit(text[end])) ++end;
      const auto number = Whole(text.substr(at, end - at));
      if (!number) return {};
      numbers.push_back(*number);
      at = end;
    }
    expected = !expected;
  }
  return expected ? std::vector<std::uint64_t>{} : numbers;
}

Spoken Date(const std::string& text, std::string format, bool japanese) {
  const auto numbers = NumbersOf(text, "/-. ");
  if (numbers.empty()) return {};
  if (format.empty()) {
    const bool year_first = numbers[0] > 31;
    format = numbers.size() == 1      ? (year_first ? "y" : "d")
             : numbers.size() == 2    ? (year_first ? "ym" : "md")
             : year_first || japanese ? "ymd"
                                      : "mdy";
  }
  if (format.size() != numbers.size()) return {};
  std::optional<std::uint64_t> year, month, day;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] == 'y') year = numbers[i];
    if (format[i] == 'm') month = numbers[i];
    if (format[i] == 'd') day = numbers[i];
  }
  if ((month && (*month < 1 || *month > 12)) || (day && (*day < 1 || *day > 31))) return {};
  std::string said;
  if (japanese) {
    if (year) said += std::to_string(*year) + "年";
    if (month) said += std::to_string(*month) + "月";
    if (day) said += std::to_string(*day) + "日";
    return said;
  }
  if (month) said = kMonths[*month - 1];
  if (day) AddWord(said, Ordinal(*day));
  if (year) said += (said.empty() ? "" : ", ") + Year(*year);
  return said;
}

Spoken Time(std::string text, std::string_view format, bool japanese) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  });
  std::optional<bool> afternoon;
  for (const auto& [ending, after] : {std::pair<std::string_view, bool>{"p.m.", true},
                                      {"pm", true},
                                      {"a.m.", false},
                                      {"am", false}}) {
    if (!text.ends_with(ending)) continue;
    text = Trimmed(text.substr(0, text.size() - ending.size()));
    afternoon = after;
    break;
  }
  const auto numbers = NumbersOf(text, ":.");
  if (numbers.empty() || numbers.size() > 3 || numbers[0] > 24) return {};
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (numbers[i] > 59) return {};
  }
  std::uint64_t hour = numbers[0];
  if (!afternoon && format == "hms12") {
    afternoon = hour >= 12 && hour < 24;
    hour = (hour + 11) % 12 + 1;
  }
  if (japanese) {
    std::string said = afternoon ? (*afternoon ? "午後" : "午前") : "";
    said += std::to_string(hour) + "時";
    if (numbers.size() > 1) said += std::to_string(numbers[1]) + "分";
    if (numbers.size() > 2) said += std::to_string(numbers[2]) + "秒";
    return said;
  }
  std::string said = Cardinal(hour);
  if (numbers.size() > 1 && numbers[1] > 0) {
    AddWord(said, (numbers[1] < 10 ? "oh " : "") + Cardinal(numbers[1]));
  } else if (!afternoon) {
    AddWord(said, hour > 12 || hour == 0 ? "hundred hours" : "o'clock");
  }
  if (numbers.size() > 2) {
    said += " and " + Cardinal(numbers[2]) + (numbers[2] == 1 ? " second" : " seconds");
  }
  if (afternoon) AddWord(said, *afternoon ? "P M" : "A M");
  return said;
}

Spoken Money(std::string text, bool japanese) {
  const Currency* currency = nullptr;
  for (const Currency& known : kCurrencies) {
    for (const std::string_view name : {known.sign, known.code}) {
      const bool before = text.starts_with(name);
      if (!before && !text.ends_with(name)) continue;
      text = Trimmed(before ? text.substr(name.size()) : text.substr(0, text.size() - name.size()));
      currency = &known;
      break;
    }
    if (currency != nullptr) break;
  }
  if (currency == nullptr) return {};
  const std::size_t point = text.find('.');
  const auto whole = Whole(text.substr(0, point));
  if (!whole) return {};
  std::string fraction = point == std::string::npos ? "" : text.substr(point + 1);
  if (fraction.size() > 2 || !std::ranges::all_of(fraction, IsDigit)) return {};
  if (japanese) return text + std::string(currency->japanese);
  if (fraction.size() == 1) fraction += '0';
  const auto cents = Whole(fraction).value_or(0);
  std::string said = Cardinal(*whole);
  AddWord(said, *whole == 1 ? currency->one : currency->many);
  if (cents > 0) {
    said += " and " + Cardinal(cents);
    AddWord(said, cents == 1 ? currency->cent : currency->cents);
  }
  return said;
}

Spoken Number(const std::string& text, bool ordinal, bool japanese) {
  std::string digits = text;
  if (ordinal) {
    for (const std::string_view ending : {"st", "nd", "rd", "th", "番目"}) {
      if (digits.ends_with(ending)) digits.erase(digits.size() - ending.size());
    }
  }
  const bool negative = digits.starts_with('-') || digits.starts_with("−");
  if (negative) digits.erase(0, digits.starts_with('-') ? 1 : 3);
  const auto number = Whole(digits);
  if (!number) return {};
  if (japanese) return (negative ? "マイナス" : "") + digits + (ordinal ? "番目" : "");
  return (negative ? "minus " : "") + (ordinal ? Ordinal(*number) : Cardinal(*number));
}

Spoken Telephone(const std::string& text, bool japanese) {
  const std::string digits = SpacedDigits(text);
  if (digits.empty()) return {};
  return (text.starts_with('+') ? (japanese ? "プラス、" : "plus ") : "") + digits;
}

}  // namespace

Spoken SpokenForm(std::string_view how, std::string_view format, std::string_view text,
                  std::string_view language) {
  const bool japanese = language.starts_with("ja");
  const std::string plain = Trimmed(text);
  if (how == "characters" || how == "spell-out") return SpellOut(plain);
  if (how == "digits" || (how == "number" && format == "digits")) {
    const std::string digits = SpacedDigits(plain);
    return digits.empty() ? Spoken() : digits;
  }
  if (how == "telephone" || (how == "number" && format == "telephone")) {
    return Telephone(plain, japanese);
  }
  if (how == "ordinal" || (how == "number" && format == "ordinal")) {
    return Number(plain, true, japanese);
  }
  if (how == "cardinal" || how == "number") return Number(plain, false, japanese);
  if (how == "date") return Date(plain, std::string(format), japanese);
  if (how == "time") return Time(plain, format, japanese);
  if (how == "currency") return Money(plain, japanese);
  return {};
}

std::string_view ExpectedOf(std::string_view how) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kExpected = {
      {{"characters", "letters or figures"},
       {"spell-out", "letters or figures"},
       {"digits", "figures"},
       {"telephone", "figures"},
       {"cardinal", "a whole number of at most 15 digits"},
       {"number", "a whole number of at most 15 digits"},
       {"ordinal", "a whole number of at most 15 digits"},
       {"date", "the figures its format names, with / - or . between"},
       {"time", "hours, minutes and seconds as 14:30 or 2:05pm"},
       {"currency", "an amount with $, €, £, ¥ or the code of one of them"}}};
  const auto found = std::ranges::find(kExpected, how, [](const auto& it) { return it.first; });
  return found == kExpected.end() ? std::string_view() : found->second;
}

}  // namespace ssm
