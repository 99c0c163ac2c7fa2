#include "vm_protocol/core/phonemes.h"

#include <cmath>
#include <cstdlib>

#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/limits.h"

namespace vm {
namespace {

constexpr double kMaxPhonemeMs = 60'000;

/// Reads items of the form NAME[MS], NAME [MS], NAME MS.
class PhonemeParser {
 public:
  explicit PhonemeParser(std::string_view text) : text_(text) {}

  Result<PhonemeList> Parse() {
    PhonemeList list;
    for (SkipBlanks(); at_ < text_.size(); SkipBlanks()) {
      const std::size_t name_at = at_;
      const std::string_view name = ReadUntil("[ \t");
      if (name == "phoneme_end" && Rest().empty()) break;
      if (name.empty()) return Bad(name_at, "a phoneme's name");
      if (name.find(']') != std::string_view::npos) return Bad(name_at, "a phoneme's name");
      SkipBlanks();
      const bool bracket = at_ < text_.size() && text_[at_] == '[';
      if (bracket) ++at_;
      SkipBlanks();
      const std::size_t number_at = at_;
      const std::string number(ReadUntil(bracket ? "] \t" : " \t"));
      char* end = nullptr;
      const double ms = std::strtod(number.c_str(), &end);
      const bool decimal = number.find_first_not_of("0123456789.") == std::string::npos;
      if (number.empty() || !decimal || *end != '\0' || !(ms >= 0 && ms <= kMaxPhonemeMs)) {
        return Bad(number_at, "the duration of '" + std::string(name) + "' in ms, 0 to 60000");
      }
      if (bracket) {
        SkipBlanks();
        if (at_ >= text_.size() || text_[at_] != ']') return Bad(at_, "']'");
        ++at_;
      }
      if (list.size() == kMaxPhonemes) {
        return Fail(Errc::kLimit, "more than " + std::to_string(kMaxPhonemes) + " phonemes",
                    name_at + 1);
      }
      list.push_back({std::string(name), std::chrono::milliseconds(std::lround(ms))});
    }
    return list;
  }

 private:
  void SkipBlanks() {
    while (at_ < text_.size() && IsBlank(text_[at_])) ++at_;
  }
  std::string_view Rest() {
    SkipBlanks();
    return text_.substr(at_);
  }
  std::string_view ReadUntil(std::string_view stops) {
    const std::size_t end = std::min(text_.find_first_of(stops, at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    return word;
  }
  std::unexpected<Error> Bad(std::size_t at, const std::string& expected) const {
    std::size_t end = std::min(text_.find_first_of(" \t", at), text_.size());
    if (end - at > 40) end = at + 40;
    const std::string found =
        at >= text_.size() ? "the end" : "'" + std::string(text_.substr(at, end - at)) + "'";
    return Fail(Errc::kBadValue, "found " + found + ", expected " + expected, at + 1);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

std::string Join(const PhonemeList& list, std::string_view before_ms, std::string_view after_ms,
                 bool trailing_blank) {
  std::string text;
  for (const Phoneme& phoneme : list) {
    if (!text.empty() && !trailing_blank) text += ' ';
    text += phoneme.name;
    text += before_ms;
    text += std::to_string(phoneme.duration.count());
    text += after_ms;
    if (trailing_blank) text += ' ';
  }
  return text;
}

}  // namespace

Result<PhonemeList> ParsePhonemes(std::string_view text) { return PhonemeParser(text).Parse(); }

std::string FormatPhonemesVoice(const PhonemeList& list) { return Join(list, "[", "]", false); }
std::string FormatPhonemesFace(const PhonemeList& list) { return Join(list, " [", "]", true); }
std::string FormatPhonemesPlain(const PhonemeList& list) { return Join(list, " ", "", false); }

std::chrono::milliseconds TotalDuration(const PhonemeList& list) {
  std::chrono::milliseconds total{0};
  for (const Phoneme& phoneme : list) total += phoneme.duration;
  return total;
}

PhonemeList SpokenPart(const PhonemeList& list, std::chrono::milliseconds spoken) {
  PhonemeList part;
  for (const Phoneme& phoneme : list) {
    if (spoken <= std::chrono::milliseconds(0)) break;
    part.push_back({phoneme.name, std::min(phoneme.duration, spoken)});
    spoken -= phoneme.duration;
  }
  return part;
}

}  // namespace vm
