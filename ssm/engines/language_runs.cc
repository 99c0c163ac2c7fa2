#include "ssm/engines/language_runs.h"

#include <algorithm>
#include <array>
#include <utility>

#include "vm_protocol/core/charset.h"
#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

enum class Script { kNone, kLatin, kKana, kHan, kHangul, kCyrillic, kGreek, kArabic, kDevanagari };

struct Range {
  char32_t first, last;
  Script script;
};
constexpr std::array<Range, 14> kRanges = {{{'A', 'Z', Script::kLatin},
                                            {'a', 'z', Script::kLatin},
                                            {0xC0, 0x24F, Script::kLatin},
                                            {0x370, 0x3FF, Script::kGreek},
                                            {0x400, 0x52F, Script::kCyrillic},
                                            {0x600, 0x6FF, Script::kArabic},
                                            {0x900, 0x97F, Script::kDevanagari},
                                            {0x1100, 0x11FF, Script::kHangul},
                                            {0x1E00, 0x1EFF, Script::kLatin},
                                            {0x3005, 0x3007, Script::kHan},
                                            {0x3041, 0x30FE, Script::kKana},
                                            {0x3400, 0x9FFF, Script::kHan},
                                            {0xAC00, 0xD7A3, Script::kHangul},
                                            {0xF900, 0xFAFF, Script::kHan}}};

// See ssm/voice/pronounced_text.h.
constexpr char32_t kPronouncedBegin = 0xE000;
constexpr std::string_view kPronouncedEnd = "\xEE\x80\x82";

Script ScriptOf(char32_t code) {
  if (code == 0xD7 || code == 0xF7 || code == 0x30FB) return Script::kNone;
  for (const Range& range : kRanges) {
    if (code >= range.first && code <= range.last) return range.script;
  }
  return Script::kNone;
}

bool IsOneOf(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Script ScriptOfLanguage(std::string_view language) {
  if (language == "ja") return Script::kKana;
  if (IsOneOf(language, {"zh", "yue"})) return Script::kHan;
  if (language == "ko") return Script::kHangul;
  if (IsOneOf(language, {"ru", "uk", "bg", "sr"})) return Script::kCyrillic;
  if (language == "el") return Script::kGreek;
  if (IsOneOf(language, {"ar", "fa"})) return Script::kArabic;
  if (language == "hi") return Script::kDevanagari;
  if (IsOneOf(language, {"ta", "bn", "ka", "hy"})) return Script::kNone;
  return Script::kLatin;
}

std::string LanguageOf(Script script, std::string_view base, std::string_view ideographs) {
  const Script own = ScriptOfLanguage(base);
  if (script == own) return std::string(base);
  switch (script) {
    case Script::kKana:
      return "ja";
    case Script::kHan:
      return std::string(ideographs);
    case Script::kHangul:
      return "ko";
    case Script::kCyrillic:
      return "ru";
    case Script::kGreek:
      return "el";
    case Script::kArabic:
      return "ar";
    case Script::kDevanagari:
      return "hi";
    case Script::kLatin:
      return "en";
    case Script::kNone:
      break;
  }
  return std::string(base);
}

/// The Latin letters at the front, if they are an acronym that Japanese speakers spell out.
bool IsAcronym(std::string_view text) {
  std::size_t size = 0;
  while (size < text.size() && text[size] >= 'A' && text[size] <= 'Z') ++size;
  return size >= 1 && size <= 3 && ScriptOf(vm::SignAt(text, size).value) != Script::kLatin;
}

}  // namespace

std::vector<LanguageRun> SplitLanguages(std::string_view text, std::string_view base,
                                        std::string_view ideographs) {
  std::vector<LanguageRun> runs;
  std::string leading;  // signs before the first letter go with it
  bool in_acronym = false;
  for (std::string_view rest = text; !rest.empty();) {
    const vm::CodePoint c = vm::SignAt(rest, 0);
    const std::string_view written = rest.substr(0, c.length);
    if (c.value == kPronouncedBegin) {  // such a word goes with what is before it
      const std::size_t end = rest.find(kPronouncedEnd);
      const std::size_t bytes = end == rest.npos ? c.length : end + kPronouncedEnd.size();
      (runs.empty() ? leading : runs.back().text) += rest.substr(0, bytes);
      rest.remove_prefix(bytes);
      continue;
    }
    const Script script = ScriptOf(c.value);
    const bool word_begins =
        script == Script::kLatin &&
        (written.data() == text.data() ||
         ScriptOf(static_cast<unsigned char>(written.data()[-1])) != Script::kLatin);
    if (word_begins) in_acronym = base == "ja" && IsAcronym(rest);
    rest.remove_prefix(c.length);
    if (script == Script::kNone) {
      (runs.empty() ? leading : runs.back().text) += written;
      continue;
    }
    const std::string language =
        script == Script::kLatin && in_acronym ? "ja" : LanguageOf(script, base, ideographs);
    if (runs.empty() || runs.back().language != language) {
      runs.push_back({language, std::exchange(leading, {})});
    }
    runs.back().text += written;
  }
  if (runs.empty() && !leading.empty()) runs.push_back({std::string(base), leading});
  return runs;
}

std::vector<LanguageRun> SplitAsked(std::string_view text, const std::string& language) {
  const std::u32string signs = vm::SignsOf(text);
  const bool other = std::ranges::any_of(signs, [](char32_t c) {
    return ScriptOf(c) != Script::kNone && ScriptOf(c) != Script::kLatin;
  });
  if (other) return SplitLanguages(text, language);
  return {{language, std::string(text)}};
}

Ideographs FindIdeographs(std::string_view text) {
  Ideographs found;
  for (std::size_t at = 0; at < text.size();) {
    const vm::CodePoint c = vm::SignAt(text, at);
    const Script script = ScriptOf(c.value);
    found.kana = found.kana || script == Script::kKana;
    if (script == Script::kHan) {
      found.any = true;
      const auto japanese = vm::EncodeCharset(text.substr(at, c.length), "CP932");
      found.beyond_japanese = found.beyond_japanese || (japanese && *japanese == "?");
    }
    at += c.length;
  }
  return found;
}

}  // namespace ssm
