#include "ssm/japanese/normalizer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

/// More digits without commas, unit or counter are the number of a card or an account.
constexpr std::size_t kMostBareDigits = 15;

struct Unit {
  std::string_view name;
  std::size_t zeros;
};
constexpr std::array<Unit, 5> kLargeUnits = {
    {{"垓", 20}, {"京", 16}, {"兆", 12}, {"億", 8}, {"万", 4}}};
constexpr std::array<Unit, 2> kSmallUnits = {{{"千", 3}, {"百", 2}}};

constexpr const char* kMinus = "マイナス";
constexpr std::string_view kMinusSign = "−";  // U+2212
constexpr std::size_t kOneBytes = std::string_view("イチ").size();

struct Currency {
  std::string_view sign, counter;
};
constexpr std::array<Currency, 3> kCurrencies = {{{"¥", "円"}, {"￥", "円"}, {"$", "ドル"}}};

/// Counters that name one of a row. What is before them is no fraction: 1/2番線 are two platforms.
constexpr std::array<std::string_view, 10> kNaming = {"月",   "日",   "年", "時",   "番",
                                                      "番線", "番目", "号", "号車", "階"};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// Wide letters, digits and signs as their ASCII forms.
std::string Narrow(std::string_view text) {
  static constexpr std::u32string_view kKept = U"！？，";
  std::string narrow;
  for (std::size_t at = 0; at < text.size();) {
    const auto [sign, bytes] = vm::SignAt(text, at);
    if (sign >= 0xFF01 && sign <= 0xFF5E && !kKept.contains(sign)) {
      narrow += static_cast<char>(sign - 0xFF01 + '!');
    } else {
      narrow += text.substr(at, bytes);
    }
    at += bytes;
  }
  return narrow;
}

class Normalizer {
 public:
  Normalizer(std::string text, const Counters& counters)
      : text_(std::move(text)), counters_(counters) {}

  std::vector<JapanesePart> Run() {
    while (at_ < text_.size()) {
      if (IsDigit(text_[at_])) {
        Number();
      } else if (IsLetter(text_[at_])) {
        Letters();
      } else if (!Money()) {
        plain_ += text_[at_++];
      }
    }
    Flush();
    return std::move(parts_);
  }

 private:
  std::string_view Rest() const { return std::string_view(text_).substr(at_); }
  void Flush() {
    if (!plain_.empty()) parts_.push_back({std::exchange(plain_, {}), {}});
  }
  void Put(std::size_t end, std::string reading) {
    Flush();
    parts_.push_back({text_.substr(at_, end - at_), std::move(reading)});
    at_ = end;
  }
  std::size_t DigitsFrom(std::size_t at) const {
    while (at < text_.size() && IsDigit(text_[at])) ++at;
    return at;
  }
  std::string_view Digits(std::size_t begin, std::size_t end) const {
    return std::string_view(text_).substr(begin, end - begin);
  }
  /// The value of at most two digits; none if there are more, or no digit.
  std::optional<int> Small(std::size_t begin, std::size_t end) const {
    if (end <= begin || end - begin > 2) return std::nullopt;
    int value = 0;
    for (const char digit : Digits(begin, end)) value = 10 * value + (digit - '0');
    return value;
  }

  void Letters() {
    std::size_t end = at_;
    std::string reading;
    for (; end < text_.size() && IsLetter(text_[end]); ++end) reading += LetterName(text_[end]);
    Put(end, std::move(reading));
  }

  /// ¥500 and $20: the number first, then the money.
  bool Money() {
    const auto money = std::ranges::find_if(
        kCurrencies, [this](const Currency& c) { return Rest().starts_with(c.sign); });
    if (money == kCurrencies.end()) return false;
    std::size_t end = at_ + money->sign.size();
    const std::size_t minus = MinusAt(end);
    end += minus;
    if (end >= text_.size() || !IsDigit(text_[end])) return false;
    const Quantity amount = QuantityAt(end);
    Sign(amount.end, (minus > 0 ? kMinus : "") + With(amount, money->counter));
    return true;
  }

  /// Length of a minus sign, 0 if there is none.
  std::size_t MinusAt(std::size_t at) const {
    const std::string_view rest = std::string_view(text_).substr(std::min(at, text_.size()));
    return rest.starts_with('-') ? 1 : rest.starts_with(kMinusSign) ? kMinusSign.size() : 0;
  }

  /// Digits with commas, also wide ones, between groups of three; `end` moves behind them.
  std::string Grouped(std::size_t& end) const {
    std::size_t stop = DigitsFrom(end);
    std::string digits(Digits(end, stop));
    end = stop;
    if (digits.size() > 3 || digits.starts_with('0')) return digits;
    for (;;) {
      const std::string_view rest = std::string_view(text_).substr(end);
      const std::size_t comma = rest.starts_with(',') ? 1 : rest.starts_with("，") ? 3 : 0;
      if (comma == 0 || DigitsFrom(end + comma) != end + comma + 3) return digits;
      digits += Digits(end + comma, end + comma + 3);
      end += comma + 3;
    }
  }

  bool FollowedBy(std::size_t at, char sign) const {
    return at + 1 < text_.size() && text_[at] == sign && IsDigit(text_[at + 1]);
  }

  void Number() {
    const std::size_t first = DigitsFrom(at_);
    if (FollowedBy(first, ':') && Time(first)) return;
    if (FollowedBy(first, '/') && (Fraction(first) || Date(first, '/'))) return;
    if (FollowedBy(first, '-') && (Date(first, '-') || Telephone(first))) return;
    if (FollowedBy(first, '.') && (Date(first, '.') || Points(first))) return;
    if (text_[at_] == '0' && first - at_ > 1) return LeadingZeros(first);
    Amount();
  }

  bool Time(std::size_t first) {
    const std::size_t second = DigitsFrom(first + 1);
    const auto hour = Small(at_, first), minute = Small(first + 1, second);
    if (second - first != 3 || !hour || *hour > 24 || *minute > 59) return false;
    std::string reading = counters_.Read(Digits(at_, first), "時");
    if (*minute > 0) reading += counters_.Read(Digits(first + 1, second), "分");
    std::size_t end = second;
    if (FollowedBy(second, ':') && DigitsFrom(second + 1) == second + 3) {
      end = second + 3;
      const std::string_view seconds = Digits(second + 1, end);
      if (FollowedBy(end, '.')) {
        const std::size_t point = end;
        end = DigitsFrom(point + 1);
        reading += ReadDecimal(seconds, Digits(point + 1, end)) + counters_.Kana("秒");
      } else {
        reading += counters_.Read(seconds, "秒");
      }
    } else if (FollowedBy(second, '.')) {
      return false;  // minutes and seconds of a stopwatch
    }
    Moment(end, std::move(reading));
    return true;
  }

  bool Date(std::size_t first, char sign) {
    const std::size_t second = DigitsFrom(first + 1);
    const bool has_year = first - at_ == 4 && FollowedBy(second, sign);
    if (!has_year && sign != '/') return false;
    std::size_t end = has_year ? DigitsFrom(second + 1) : second;
    const auto month = has_year ? Small(first + 1, second) : Small(at_, first);
    const auto day = has_year ? Small(second + 1, end) : Small(first + 1, second);
    if (!month || !day || *month < 1 || *month > 12 || *day < 1 || *day > 31) return false;
    std::string reading = (has_year ? counters_.Read(Digits(at_, first), "年") : "") +
                          counters_.Read(std::to_string(*month), "月") +
                          counters_.Read(std::to_string(*day), "日");
    const std::string_view counter = has_year ? std::string_view() : CounterAt(end);
    if (!counter.empty() && counter != "日") return false;  // 1/2番線
    end += counter.size();
    Moment(end, std::move(reading));
    return true;
  }

  /// 1/2個; without a counter it may be a date.
  bool Fraction(std::size_t first) {
    const std::size_t end = DigitsFrom(first + 1);
    const std::string_view counter = CounterAt(end);
    if (counter.empty() || std::ranges::find(kNaming, counter) != kNaming.end()) return false;
    Sign(end + counter.size(), ReadNumber(Digits(first + 1, end)) + "ブンノ" +
                                   ReadNumber(Digits(at_, first)) + counters_.Kana(counter));
    return true;
  }

  /// 1.2.3 and 192.168.0.1.
  bool Points(std::size_t first) {
    std::string reading;
    std::size_t begin = at_, end = first, points = 0;
    for (; FollowedBy(end, '.'); begin = end + 1, end = DigitsFrom(begin), ++points) {
      const std::string_view digits = Digits(begin, end);
      const bool zeros = digits.size() > 1 && digits.starts_with('0');
      reading += zeros           ? ReadDigits(digits) + "テン"
                 : digits == "0" ? ReadNumber(digits) + "テン"
                                 : ReadPoint(digits);
    }
    if (points < 2) return false;
    const std::string_view digits = Digits(begin, end);
    const bool zeros = digits.size() > 1 && digits.starts_with('0');
    Put(end, reading + (zeros ? ReadDigits(digits) : ReadNumber(digits)));
    return true;
  }

  bool Telephone(std::size_t first) {
    std::string reading = ReadDigits(Digits(at_, first));
    std::size_t end = first, groups = 1;
    while (FollowedBy(end, '-')) {
      const std::size_t next = DigitsFrom(end + 1);
      reading += "ノ" + ReadDigits(Digits(end + 1, next));
      end = next;
      ++groups;
    }
    if (groups < 3 && text_[at_] != '0') return false;
    Put(end, std::move(reading));
    return true;
  }

  /// 05分 is 5分; 007 and 0120番 are digits.
  void LeadingZeros(std::size_t first) {
    const std::string_view digits = Digits(at_, first);
    const std::string_view counter = CounterAt(first);
    if (!counter.empty() && digits.size() == 2) {
      return Sign(first + counter.size(), counters_.Read(digits, counter));
    }
    std::string reading = ReadDigits(digits);
    if (FollowedBy(first, '.')) {
      const std::size_t end = DigitsFrom(first + 1);
      const std::string_view unit = CounterAt(end);
      reading += "テン" + ReadDigits(Digits(first + 1, end));
      return Sign(end + unit.size(), reading + (unit.empty() ? "" : counters_.Kana(unit)));
    }
    Sign(first + counter.size(), reading + (counter.empty() ? "" : counters_.Kana(counter)));
  }

  /// How much there is of something, without its counter.
  struct Quantity {
    std::string digits{};   ///< a whole number; empty if there is a decimal
    std::string decimal{};  ///< the reading of one, with its unit
    bool bare = true;       ///< nothing but digits: neither commas nor a unit
    std::size_t end = 0;
  };

  /// A number, perhaps with commas, with decimals or with Chinese units. REQUIRES: a digit at `at`.
  Quantity QuantityAt(std::size_t at) const {
    Quantity read;
    std::size_t end = at;
    read.digits = Grouped(end);
    read.bare = end - at == read.digits.size();
    if (FollowedBy(end, '.')) {
      const std::size_t point = end;
      end = DigitsFrom(point + 1);
      read.decimal = ReadDecimal(read.digits, Digits(point + 1, end));
      read.digits.clear();
      if (const Unit* unit = UnitAt(end, kLargeUnits)) {
        read.decimal += ReadNumber("1" + std::string(unit->zeros, '0')).substr(kOneBytes);
        end += unit->name.size();
      }
    } else {
      const std::size_t before = end;
      read.digits = InUnits(std::move(read.digits), end, kLargeUnits);
      read.bare = read.bare && end == before;
    }
    read.end = end;
    return read;
  }

  std::string With(const Quantity& amount, std::string_view counter) const {
    if (amount.digits.empty()) return amount.decimal + counters_.Kana(counter);
    return counters_.Read(amount.digits, counter);
  }

  void Amount() {
    const Quantity amount = QuantityAt(at_);
    constexpr std::string_view kShare = "分の";
    const std::size_t share = amount.end + kShare.size();
    if (!amount.digits.empty() && text_.compare(amount.end, kShare.size(), kShare) == 0 &&
        share < text_.size() && IsDigit(text_[share])) {
      return Share(amount.digits, share);
    }
    const std::string_view counter = CounterAt(amount.end);
    if (!counter.empty()) return Sign(amount.end + counter.size(), With(amount, counter));
    if (amount.digits.empty()) return Sign(amount.end, amount.decimal);
    const bool spelled = amount.bare && amount.digits.size() > kMostBareDigits;
    Sign(amount.end, spelled ? ReadDigits(amount.digits) : ReadNumber(amount.digits));
  }

  /// 3分の2: the whole first. `begin`: of the part.
  void Share(const std::string& whole, std::size_t begin) {
    const Quantity part = QuantityAt(begin);
    const std::string_view counter = CounterAt(part.end);
    Sign(part.end + counter.size(),
         ReadNumber(whole) + "ブンノ" +
             (part.digits.empty() ? part.decimal : ReadNumber(part.digits)) +
             (counter.empty() ? "" : counters_.Kana(counter)));
  }

  /// The unit at a place; none if it begins a word: 第2京阪.
  const Unit* UnitAt(std::size_t at, std::span<const Unit> units) const {
    const std::string_view rest = std::string_view(text_).substr(at);
    for (const Unit& unit : units) {
      if (!rest.starts_with(unit.name)) continue;
      const std::size_t behind = at + unit.name.size();
      const char32_t next = vm::SignAt(text_, behind).value;
      const bool kanji = behind < text_.size() && next >= 0x4E00 && next <= 0x9FFF;
      const bool word = unit.name == "京" && kanji && CounterAt(behind).empty();
      return word ? nullptr : &unit;
    }
    return nullptr;
  }

  /// 3万5千 and 3千万: units behind the digits, each smaller than the one before, and the digits
  /// that take the place of their zeros. `end` is behind `digits` and moves behind them all.
  std::string InUnits(std::string digits, std::size_t& end, std::span<const Unit> units) const {
    const bool small = units.data() == kSmallUnits.data();
    std::string total;
    std::size_t room = std::string::npos;  // how many zeros there are
    for (std::size_t stop = end;;) {
      if (!small) digits = InUnits(std::move(digits), stop, kSmallUnits);
      const Unit* unit = small && digits.size() != 1 ? nullptr : UnitAt(stop, units);
      if (unit != nullptr && unit->zeros >= room) unit = nullptr;
      const std::string term = digits + std::string(unit != nullptr ? unit->zeros : 0, '0');
      if (term.size() > room) return total;  // another number
      total.resize(total.size() - std::min(term.size(), total.size()));
      total += term;
      end = stop + (unit != nullptr ? unit->name.size() : 0);
      if (unit == nullptr || end >= text_.size() || !IsDigit(text_[end])) return total;
      room = unit->zeros;
      stop = end;
      digits = Grouped(stop);
    }
  }

  /// A one-letter unit must not be the beginning of a word.
  std::string_view CounterAt(std::size_t at) const {
    const std::string_view counter = counters_.Find(std::string_view(text_).substr(at));
    const std::size_t behind = at + counter.size();
    const bool latin = !counter.empty() && IsLetter(counter.back());
    return latin && behind < text_.size() && IsLetter(text_[behind]) ? std::string_view() : counter;
  }

  /// Puts a number, with the minus or the ~ before it.
  void Sign(std::size_t end, std::string reading) {
    const std::size_t minus = plain_.ends_with('-')          ? 1
                              : plain_.ends_with(kMinusSign) ? kMinusSign.size()
                                                             : 0;
    if (minus > 0 && !(minus == 1 && IsJoined(at_ - minus))) {
      std::string sign = plain_.substr(plain_.size() - minus);
      plain_.resize(plain_.size() - minus);
      Flush();
      parts_.push_back({std::move(sign), kMinus});
    } else if (plain_ == "~" || plain_ == "〜") {
      From();
    }
    Put(end, std::move(reading));
  }

  /// Puts a date or a time; a - before it is no minus.
  void Moment(std::size_t end, std::string reading) {
    if (plain_ == "-" || plain_ == "~" || plain_ == "〜") From();
    Put(end, std::move(reading));
  }

  /// What is between two numbers is read から.
  void From() {
    if (!parts_.empty()) parts_.push_back({std::exchange(plain_, {}), "カラ"});
  }

  /// Whether a hyphen at a place joins what is before it to what follows: F-16, コロナ-19, --5.
  bool IsJoined(std::size_t at) const {
    if (at == 0) return false;
    std::size_t before = at - 1;
    while (before > 0 && !vm::BeginsSign(text_[before])) --before;
    const char32_t sign = vm::SignAt(text_, before).value;
    return sign == '-' || IsLetter(text_[before]) || (sign >= 0x30A0 && sign <= 0x30FF);
  }

  const std::string text_;
  const Counters& counters_;
  std::size_t at_ = 0;
  std::string plain_;
  std::vector<JapanesePart> parts_;
};

}  // namespace

std::vector<JapanesePart> NormalizeJapanese(std::string_view text, const Counters& counters) {
  return Normalizer(Narrow(text), counters).Run();
}

}  // namespace ssm
