#include "ssm/japanese/normalizer.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

constexpr std::size_t kMaxDigits = 15;

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
  std::uint64_t Value(std::size_t begin, std::size_t end) const {
    return std::strtoull(text_.substr(begin, end - begin).c_str(), nullptr, 10);
  }

  void Letters() {
    std::size_t end = at_;
    std::string reading;
    for (; end < text_.size() && IsLetter(text_[end]); ++end) reading += LetterName(text_[end]);
    Put(end, std::move(reading));
  }

  /// ¥500 and $20: the number first, then the money.
  bool Money() {
    const bool yen = Rest().starts_with("¥") || Rest().starts_with("￥");
    if (!yen && !Rest().starts_with("$")) return false;
    const std::size_t sign = Rest().starts_with("$") ? 1 : Rest().starts_with("¥") ? 2 : 3;
    const std::size_t begin = at_ + sign;
    if (begin >= text_.size() || !IsDigit(text_[begin])) return false;
    std::size_t end = begin;
    const std::uint64_t value = Grouped(end);
    Put(end, counters_.Find("円").empty() || !yen ? ReadNumber(value) + "ドル"
                                                  : counters_.Read(value, "円"));
    return true;
  }

  /// Digits with commas between groups of three; `end` moves behind them.
  std::uint64_t Grouped(std::size_t& end) const {
    std::string digits;
    std::size_t stop = DigitsFrom(end);
    digits = text_.substr(end, stop - end);
    while (stop < text_.size() && text_[stop] == ',' && DigitsFrom(stop + 1) == stop + 4) {
      digits += text_.substr(stop + 1, 3);
      stop += 4;
    }
    end = stop;
    return std::strtoull(digits.substr(0, kMaxDigits).c_str(), nullptr, 10);
  }

  bool FollowedBy(std::size_t at, char sign) const {
    return at + 1 < text_.size() && text_[at] == sign && IsDigit(text_[at + 1]);
  }

  void Number() {
    const std::size_t first = DigitsFrom(at_);
    if (first - at_ > kMaxDigits) return Put(first, ReadDigits(text_.substr(at_, first - at_)));
    if (FollowedBy(first, ':') && Time(first)) return;
    if (FollowedBy(first, '/') && Date(first, '/')) return;
    if (FollowedBy(first, '-') && (Date(first, '-') || Telephone(first))) return;
    if (text_[at_] == '0' && first - at_ > 1) {
      return Put(first, ReadDigits(text_.substr(at_, first - at_)));
    }
    Amount();
  }

  bool Time(std::size_t first) {
    const std::size_t second = DigitsFrom(first + 1);
    const std::uint64_t hour = Value(at_, first), minute = Value(first + 1, second);
    if (first - at_ > 2 || second - first != 3 || hour > 24 || minute > 59) return false;
    std::string reading = counters_.Read(hour, "時");
    if (minute > 0) reading += counters_.Read(minute, "分");
    std::size_t end = second;
    if (FollowedBy(second, ':') && DigitsFrom(second + 1) == second + 3) {
      reading += counters_.Read(Value(second + 1, second + 3), "秒");
      end = second + 3;
    }
    Put(end, std::move(reading));
    return true;
  }

  bool Date(std::size_t first, char sign) {
    const std::size_t second = DigitsFrom(first + 1);
    const bool has_year = first - at_ == 4 && FollowedBy(second, sign);
    if (!has_year && sign == '-') return false;
    const std::size_t end = has_year ? DigitsFrom(second + 1) : second;
    const std::uint64_t month = has_year ? Value(first + 1, second) : Value(at_, first);
    const std::uint64_t day = has_year ? Value(second + 1, end) : Value(first + 1, second);
    if (month < 1 || month > 12 || day < 1 || day > 31) return false;
    Put(end, (has_year ? counters_.Read(Value(at_, first), "年") : "") +
                 counters_.Read(month, "月") + counters_.Read(day, "日"));
    return true;
  }

  bool Telephone(std::size_t first) {
    std::string reading = ReadDigits(text_.substr(at_, first - at_));
    std::size_t end = first, groups = 1;
    while (FollowedBy(end, '-')) {
      const std::size_t next = DigitsFrom(end + 1);
      reading += "ノ" + ReadDigits(text_.substr(end + 1, next - end - 1));
      end = next;
      ++groups;
    }
    if (groups < 3 && text_[at_] != '0') return false;
    Put(end, std::move(reading));
    return true;
  }

  /// A number, perhaps with decimals or with units of ten thousand, and its counter.
  void Amount() {
    std::size_t end = at_;
    std::uint64_t value = Grouped(end);
    if (FollowedBy(end, '.')) {
      const std::size_t stop = DigitsFrom(end + 1);
      std::string reading =
          ReadNumber(value) + "テン" + ReadDigits(text_.substr(end + 1, stop - end - 1));
      const std::string_view counter = counters_.Find(std::string_view(text_).substr(stop));
      if (!counter.empty()) reading += counters_.Read(2, counter).substr(std::string("ニ").size());
      return Sign(stop + counter.size(), std::move(reading));
    }
    value = Units(value, end);
    const std::string_view counter = CounterAt(end);
    if (counter.empty()) return Sign(end, ReadNumber(value));
    Sign(end + counter.size(), counters_.Read(value, counter));
  }

  /// 3万5千 and the like: Chinese units behind the digits.
  std::uint64_t Units(std::uint64_t value, std::size_t& end) const {
    static constexpr std::pair<std::string_view, std::uint64_t> kUnits[] = {
        {"兆", 1'000'000'000'000}, {"億", 100'000'000}, {"万", 10'000}, {"千", 1'000}};
    std::uint64_t total = 0;
    for (const auto& [unit, scale] : kUnits) {
      if (value >= 10'000 || !std::string_view(text_).substr(end).starts_with(unit)) continue;
      total += value * scale;
      end += unit.size();
      value = 0;
      if (end < text_.size() && IsDigit(text_[end])) value = Grouped(end);
    }
    return total + value;
  }

  /// A one-letter unit must not be the beginning of a word.
  std::string_view CounterAt(std::size_t at) const {
    const std::string_view counter = counters_.Find(std::string_view(text_).substr(at));
    const std::size_t behind = at + counter.size();
    const bool latin = !counter.empty() && IsLetter(counter.back());
    return latin && behind < text_.size() && IsLetter(text_[behind]) ? std::string_view() : counter;
  }

  void Sign(std::size_t end, std::string reading) {
    // A minus stands before the number and after nothing that it could join.
    if (plain_.ends_with('-') && (plain_.size() == 1 || plain_[plain_.size() - 2] == ' ')) {
      plain_.pop_back();
      Flush();
      parts_.push_back({"-", "マイナス"});
    } else if (plain_ == "~" && !parts_.empty()) {
      plain_.clear();
      parts_.push_back({"~", "カラ"});
    }
    Put(end, std::move(reading));
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
