#include "ssm_stub/phoneme_table.h"

#include <cstddef>
#include <cstdint>

namespace ssm_stub {
namespace {

struct Length {
  std::string_view name;
  int ms;
};

// Round figures near the means of read speech; the point is that anyone can add them up.
constexpr Length kLengths[] = {
    // Japanese, the 42 names of the original voice
    {"a", 90},
    {"i", 70},
    {"u", 70},
    {"e", 80},
    {"o", 80},
    {"A", 60},
    {"I", 50},
    {"U", 50},
    {"E", 60},
    {"O", 60},
    {"N", 80},
    {"cl", 90},
    {"k", 60},
    {"ky", 60},
    {"g", 50},
    {"gy", 50},
    {"s", 90},
    {"sh", 100},
    {"z", 70},
    {"j", 70},
    {"t", 50},
    {"ts", 80},
    {"ch", 80},
    {"d", 40},
    {"dy", 40},
    {"n", 50},
    {"ny", 60},
    {"h", 60},
    {"hy", 70},
    {"f", 70},
    {"b", 50},
    {"by", 50},
    {"p", 50},
    {"py", 50},
    {"m", 60},
    {"my", 60},
    {"r", 30},
    {"ry", 40},
    {"y", 50},
    {"w", 50},
    // English, flite's names (those it shares with Japanese stand above)
    {"aa", 110},
    {"ae", 120},
    {"ah", 70},
    {"ao", 120},
    {"aw", 160},
    {"ax", 60},
    {"ay", 150},
    {"dh", 50},
    {"eh", 90},
    {"er", 110},
    {"ey", 130},
    {"hh", 60},
    {"ih", 70},
    {"iy", 100},
    {"jh", 100},
    {"l", 70},
    {"ng", 80},
    {"ow", 140},
    {"oy", 170},
    {"th", 100},
    {"uh", 80},
    {"uw", 110},
    {"v", 60},
    {"zh", 90}};

struct Pause {
  std::u32string_view signs;
  int ms;
};
constexpr Pause kPauses[] = {
    {U".!?。！？…．", 400}, {U",;:、，；：\n", 200}, {U"()（）「」『』—–・", 100}};

}  // namespace

Millis PhonemeLength(std::string_view name) {
  for (const Length& length : kLengths) {
    if (length.name == name) return Millis(length.ms);
  }
  return kOtherPhoneme;
}

Millis PauseOf(char32_t sign) {
  for (const Pause& pause : kPauses) {
    if (pause.signs.find(sign) != std::u32string_view::npos) return Millis(pause.ms);
  }
  return Millis{0};
}

std::u32string Decode(std::string_view utf8) {
  std::u32string text;
  for (std::size_t at = 0; at < utf8.size();) {
    const auto byte = [&](std::size_t i) -> std::uint32_t {
      return i < utf8.size() ? static_cast<unsigned char>(utf8[i]) : 0u;
    };
    const std::uint32_t first = byte(at);
    const std::size_t bytes = first < 0x80 ? 1 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    char32_t code = bytes == 1 ? first : first & (0xFFu >> (bytes + 1));
    bool good = first < 0x80 || first >= 0xC2;
    for (std::size_t i = 1; i < bytes; ++i) {
      good = good && (byte(at + i) & 0xC0) == 0x80;
      code = code << 6 | (byte(at + i) & 0x3F);
    }
    text += good ? code : char32_t{0xFFFD};
    at += good ? bytes : 1;
  }
  return text;
}

std::string Encode(std::u32string_view text) {
  std::string utf8;
  const auto tail = [&](std::uint32_t code, int shift) {
    utf8 += static_cast<char>(0x80 | (code >> shift & 0x3F));
  };
  for (const char32_t code : text) {
    const std::uint32_t c = code;
    if (c < 0x80) {
      utf8 += static_cast<char>(c);
    } else if (c < 0x800) {
      utf8 += static_cast<char>(0xC0 | c >> 6);
      tail(c, 0);
    } else if (c < 0x10000) {
      utf8 += static_cast<char>(0xE0 | c >> 12);
      tail(c, 6);
      tail(c, 0);
    } else {
      utf8 += static_cast<char>(0xF0 | (c >> 18 & 0x07));
      tail(c, 12);
      tail(c, 6);
      tail(c, 0);
    }
  }
  return utf8;
}

}  // namespace ssm_stub
