#include "ssm_stub/phoneme_table.h"

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

}  // namespace ssm_stub
