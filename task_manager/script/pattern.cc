#include <array>
#include <charconv>

#include "task_manager/script/regexps.h"
#include "vm_protocol/core/utf8.h"

namespace vxml::script {
namespace {

struct Range {
  char32_t first, last;
};
using Ranges = std::vector<Range>;

// ECMA-262 15.10.2.12 and 7.2, 7.3: digits, word characters, blanks and line ends.
const Ranges kDigits = {{'0', '9'}};
const Ranges kWord = {{'0', '9'}, {'A', 'Z'}, {'_', '_'}, {'a', 'z'}};
const Ranges kBlanks = {{0x09, 0x0D},     {0x20, 0x20},     {0xA0, 0xA0},     {0x1680, 0x1680},
                        {0x180E, 0x180E}, {0x2000, 0x200A}, {0x2028, 0x2029}, {0x202F, 0x202F},
                        {0x205F, 0x205F}, {0x3000, 0x3000}, {0xFEFF, 0xFEFF}};
const Ranges kLineEnds = {{0x0A, 0x0A}, {0x0D, 0x0D}, {0x2028, 0x2029}};

std::string Code(char32_t c) {
  std::array<char, 8> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<unsigned>(c), 16).ptr;
  return "\\x{" + std::string(digits.data(), end) + "}";
}
std::string Inside(const Ranges& ranges) {
  std::string text;
  for (const Range& range : ranges) {
    text += Code(range.first);
    if (range.last > range.first) text += "-" + Code(range.last);
  }
  return text;
}
std::string Class(const Ranges& ranges) { return "[" + Inside(ranges) + "]"; }
std::string NoneOf(const Ranges& ranges) { return "[^" + Inside(ranges) + "]"; }
constexpr std::string_view kAnything = "(?s:.)";
/// The other case of each letter of a range is looked for when it is compiled; wide ranges hold
/// both.
constexpr char32_t kWide = 0x800;

bool IsDigit(char32_t c) { return c >= '0' && c <= '9'; }

class Translator {
 public:
  Translator(std::u32string_view source, bool multiline) : source_(source), multiline_(multiline) {}

  std::string Run() {
    while (at_ < source_.size()) {
      const char32_t c = source_[at_++];
      switch (c) {
        case '\\':
          Escape();
          break;
        case '[':
          ClassOf();
          break;
        case '.':
          out_ += NoneOf(kLineEnds);
          break;
        case '^':
          out_ += multiline_ ? "(?:\\A|(?<=" + Class(kLineEnds) + "))" : "\\A";
          break;
        case '$':
          out_ += multiline_ ? "(?=" + Class(kLineEnds) + "|\\z)" : "\\z";
          break;
        case '{':
          Braces();
          break;
        case '(':
        case ')':
        case '|':
        case '*':
        case '+':
        case '?':
          out_ += static_cast<char>(c);
          break;
        case ':':
        case '=':
        case '!':  // of (?: (?= (?!
          if (out_.ends_with("(?")) {
            out_ += static_cast<char>(c);
            break;
          }
          [[fallthrough]];
        default:
          out_ += Code(c);
      }
    }
    return std::move(out_);
  }

 private:
  char32_t Peek(std::size_t ahead = 0) const {
    return at_ + ahead < source_.size() ? source_[at_ + ahead] : 0;
  }

  /// {2} {2,} {2,5} are repeats, any other brace is itself.
  void Braces() {
    std::size_t end = at_;
    bool comma = false;
    while (end < source_.size() &&
           (IsDigit(source_[end]) || (source_[end] == ',' && !comma && end > at_))) {
      comma = comma || source_[end] == ',';
      ++end;
    }
    if (end == at_ || end >= source_.size() || source_[end] != '}') {
      out_ += Code('{');
      return;
    }
    out_ += '{';
    for (; at_ <= end; ++at_) out_ += static_cast<char>(source_[at_]);
  }

  /// The class \d, \D, \w, \W, \s or \S stands for; "" for any other letter.
  static std::string SetOf(char32_t letter) {
    switch (letter) {
      case 'd':
        return Class(kDigits);
      case 'D':
        return NoneOf(kDigits);
      case 'w':
        return Class(kWord);
      case 'W':
        return NoneOf(kWord);
      case 's':
        return Class(kBlanks);
      case 'S':
        return NoneOf(kBlanks);
      default:
        return "";
    }
  }

  /// What stands behind a backslash and is one character.
  char32_t Character() {
    const char32_t c = Peek();
    if (at_ < source_.size()) ++at_;
    switch (c) {
      case 'n':
        return '\n';
      case 'r':
        return '\r';
      case 't':
        return '\t';
      case 'v':
        return '\v';
      case 'f':
        return '\f';
      case 'c': {
        const char32_t letter = Peek() | 0x20U;
        if (letter < 'a' || letter > 'z') return c;
        ++at_;
        return letter - 'a' + 1;
      }
      case 'x':
        return Hex(2, c);
      case 'u':
        return Hex(4, c);
      default:
        return IsDigit(c) ? c - '0' : c;
    }
  }
  char32_t Hex(std::size_t digits, char32_t otherwise) {
    char32_t value = 0;
    for (std::size_t i = 0; i < digits; ++i) {
      const char32_t c = Peek(i);
      const char32_t low = c | 0x20U;
      if (!IsDigit(c) && (low < 'a' || low > 'f')) return otherwise;
      value = value * 16 + (IsDigit(c) ? c - '0' : low - 'a' + 10);
    }
    at_ += digits;
    return value;
  }

  void Escape() {
    const char32_t c = Peek();
    if (const std::string set = SetOf(c); !set.empty()) {
      ++at_;
      out_ += set;
    } else if (c == 'b' || c == 'B') {
      ++at_;
      const std::string word = Class(kWord);
      out_ += c == 'b' ? "(?:(?<=" + word + ")(?!" + word + ")|(?<!" + word + ")(?=" + word + "))"
                       : "(?:(?<=" + word + ")(?=" + word + ")|(?<!" + word + ")(?!" + word + "))";
    } else if (c >= '1' && c <= '9') {
      std::string number;
      while (IsDigit(Peek()) && number.size() < 5) number += static_cast<char>(source_[at_++]);
      out_ += "\\g{" + number + "}";
    } else {
      out_ += Code(Character());
    }
  }

  /// One character or set of a class; true if it is a single character.
  bool Atom(char32_t& single, std::vector<std::string>& sets) {
    const char32_t c = source_[at_++];
    if (c != '\\') {
      single = c;
      return true;
    }
    if (std::string set = SetOf(Peek()); !set.empty()) {
      ++at_;
      sets.push_back(std::move(set));
      return false;
    }
    if (Peek() == 'b') {
      ++at_;
      single = '\b';
      return true;
    }
    single = Character();
    return true;
  }

  /// A class becomes the choice of its parts, or what none of them is.
  void ClassOf() {
    const bool negated = Peek() == '^';
    if (negated) ++at_;
    Ranges ranges;
    std::vector<std::string> parts;
    while (at_ < source_.size() && Peek() != ']') {
      char32_t first = 0;
      if (!Atom(first, parts)) continue;
      char32_t last = first;
      if (Peek() == '-' && at_ + 1 < source_.size() && Peek(1) != ']') {
        ++at_;
        if (!Atom(last, parts)) {  // [a-\d]: the hyphen is itself
          ranges.push_back({'-', '-'});
          last = first;
        }
      }
      if (last > first && last - first > kWide) {
        parts.push_back("(?-i:" + Class({{first, last}}) + ")");
      } else {
        ranges.push_back({first, last});
      }
    }
    ++at_;
    if (!ranges.empty()) parts.push_back(Class(ranges));
    out_ += "(?:";
    if (negated) {
      for (const std::string& part : parts) out_ += "(?!" + part + ")";
      out_ += kAnything;
    } else {
      if (parts.empty()) out_ += "(?!)";
      for (std::size_t i = 0; i < parts.size(); ++i) out_ += (i == 0 ? "" : "|") + parts[i];
    }
    out_ += ")";
  }

  std::u32string_view source_;
  bool multiline_;
  std::size_t at_ = 0;
  std::string out_;
};

}  // namespace

std::u32string TranslatePattern(std::u32string_view source, bool multiline) {
  const std::string made = Translator(source, multiline).Run();
  return {made.begin(), made.end()};
}

std::u32string Characters(std::string_view text) {
  std::u32string characters;
  characters.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    if (const auto sign = vm::DecodeUtf8(text, at)) {
      characters.push_back(sign->value);
      at += sign->length;
    } else if (text[at] == '\xED' && at + 2 < text.size()) {  // half of a surrogate pair
      const auto bits = [&](std::size_t i) { return static_cast<unsigned char>(text[i]) & 0x3FU; };
      characters.push_back(0xD000U | (bits(at + 1) << 6U) | bits(at + 2));
      at += 3;
    } else {
      characters.push_back(static_cast<unsigned char>(text[at++]));
    }
  }
  return characters;
}

std::string ToUtf8(std::string_view text) {
  if (!vm::FirstBadUtf8(text)) return std::string(text);
  const std::u32string characters = Characters(text);
  std::string utf8;
  for (std::size_t i = 0; i < characters.size(); ++i) {
    const char32_t c = characters[i];
    const char32_t next = i + 1 < characters.size() ? characters[i + 1] : 0;
    const bool half = c >= 0xD800 && c <= 0xDFFF;
    if (half && c <= 0xDBFF && next >= 0xDC00 && next <= 0xDFFF) {
      vm::AppendUtf8(utf8, 0x10000 + ((c - 0xD800) << 10U) + (next - 0xDC00));
      ++i;
    } else {
      vm::AppendUtf8(utf8, half ? 0xFFFD : c);
    }
  }
  return utf8;
}

}  // namespace vxml::script
