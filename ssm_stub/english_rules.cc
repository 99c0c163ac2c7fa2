#include "ssm_stub/english_rules.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string>

#include "vm_protocol/core/lower_case.h"

namespace ssm_stub {
namespace {

struct Entry {
  std::string_view spelling;
  std::string_view phonemes;
};

// Words the letter rules get wrong and that occur in every text.
constexpr Entry kWords[] = {{"a", "ax"},
                            {"agent", "ey jh ax n t"},
                            {"am", "ae m"},
                            {"an", "ae n"},
                            {"and", "ae n d"},
                            {"any", "eh n iy"},
                            {"are", "aa r"},
                            {"be", "b iy"},
                            {"come", "k ah m"},
                            {"could", "k uh d"},
                            {"do", "d uw"},
                            {"does", "d ah z"},
                            {"eye", "ay"},
                            {"face", "f ey s"},
                            {"for", "f ao r"},
                            {"from", "f r ah m"},
                            {"galatea", "g ae l ax t iy ax"},
                            {"give", "g ih v"},
                            {"good", "g uh d"},
                            {"has", "hh ae z"},
                            {"have", "hh ae v"},
                            {"he", "hh iy"},
                            {"hello", "hh ax l ow"},
                            {"her", "hh er"},
                            {"here", "hh ih r"},
                            {"hi", "hh ay"},
                            {"how", "hh aw"},
                            {"i", "ay"},
                            {"is", "ih z"},
                            {"know", "n ow"},
                            {"me", "m iy"},
                            {"my", "m ay"},
                            {"no", "n ow"},
                            {"of", "ah v"},
                            {"one", "w ah n"},
                            {"or", "ao r"},
                            {"our", "aw er"},
                            {"said", "s eh d"},
                            {"says", "s eh z"},
                            {"she", "sh iy"},
                            {"should", "sh uh d"},
                            {"so", "s ow"},
                            {"some", "s ah m"},
                            {"talk", "t ao k"},
                            {"thank", "th ae ng k"},
                            {"thanks", "th ae ng k s"},
                            {"that", "dh ae t"},
                            {"the", "dh ax"},
                            {"their", "dh eh r"},
                            {"them", "dh eh m"},
                            {"then", "dh eh n"},
                            {"there", "dh eh r"},
                            {"these", "dh iy z"},
                            {"they", "dh ey"},
                            {"this", "dh ih s"},
                            {"those", "dh ow z"},
                            {"to", "t uw"},
                            {"today", "t ax d ey"},
                            {"two", "t uw"},
                            {"very", "v eh r iy"},
                            {"was", "w aa z"},
                            {"we", "w iy"},
                            {"were", "w er"},
                            {"what", "w ah t"},
                            {"where", "w eh r"},
                            {"who", "hh uw"},
                            {"world", "w er l d"},
                            {"would", "w uh d"},
                            {"you", "y uw"},
                            {"your", "y ao r"}};

// Letter groups, tried from the top; longer ones stand before their beginnings.
constexpr Entry kGroups[] = {
    {"tion", "sh ax n"}, {"sion", "zh ax n"}, {"ture", "ch er"}, {"ought", "ao t"},
    {"aught", "ao t"},   {"eigh", "ey"},      {"igh", "ay"},     {"ough", "ow"},
    {"tch", "ch"},       {"dge", "jh"},       {"sch", "s k"},    {"air", "eh r"},
    {"ear", "ih r"},     {"eer", "ih r"},     {"oor", "ao r"},   {"our", "ao r"},
    {"ch", "ch"},        {"sh", "sh"},        {"th", "th"},      {"ph", "f"},
    {"wh", "w"},         {"gh", ""},          {"ck", "k"},       {"ng", "ng"},
    {"nk", "ng k"},      {"qu", "k w"},       {"kn", "n"},       {"wr", "r"},
    {"ee", "iy"},        {"ea", "iy"},        {"ie", "iy"},      {"ei", "iy"},
    {"oo", "uw"},        {"ou", "aw"},        {"ow", "ow"},      {"oi", "oy"},
    {"oy", "oy"},        {"oa", "ow"},        {"ai", "ey"},      {"ay", "ey"},
    {"ey", "iy"},        {"au", "ao"},        {"aw", "ao"},      {"eu", "y uw"},
    {"ew", "uw"},        {"ue", "uw"},        {"ui", "uw"},      {"ar", "aa r"},
    {"er", "er"},        {"ir", "er"},        {"ur", "er"},      {"or", "ao r"},
    {"all", "ao l"},     {"ce", "s"},         {"x", "k s"}};

constexpr Entry kConsonants[] = {{"b", "b"},  {"c", "k"},  {"d", "d"}, {"f", "f"}, {"g", "g"},
                                 {"h", "hh"}, {"j", "jh"}, {"k", "k"}, {"l", "l"}, {"m", "m"},
                                 {"n", "n"},  {"p", "p"},  {"q", "k"}, {"r", "r"}, {"s", "s"},
                                 {"t", "t"},  {"v", "v"},  {"w", "w"}, {"y", "y"}, {"z", "z"}};
constexpr std::string_view kVowelLetters = "aeiou";
constexpr std::array<std::string_view, 5> kShort = {"ae", "eh", "ih", "aa", "ah"};
constexpr std::array<std::string_view, 5> kLong = {"ey", "iy", "ay", "ow", "uw"};

constexpr std::string_view kEnglishReadableAsRomaji[] = {
    "a",    "are",   "be",    "bee",  "bone", "came", "do",   "done", "fine", "game", "gate",
    "gene", "go",    "gone",  "he",   "here", "hi",   "home", "hope", "i",    "joke", "keep",
    "made", "make",  "man",   "me",   "more", "name", "nine", "no",   "none", "note", "on",
    "one",  "open",  "pen",   "pie",  "rose", "run",  "same", "see",  "seen", "she",  "shine",
    "site", "so",    "some",  "soon", "sure", "take", "ten",  "to",   "tone", "too",  "use",
    "we",   "wine",  "woman", "you",  "zero", "an",   "in",   "date", "ate",  "age",  "banana",
    "hero", "media", "radio", "mine", "pan",  "sun",  "tea",  "tie",  "toe",  "tune", "noon",
    "moon", "era",   "idea",  "bite", "shoe", "shy",  "to-do"};

void Split(std::string_view phonemes, PhonemeNames& into) {
  while (!phonemes.empty()) {
    const std::size_t end = std::min(phonemes.find(' '), phonemes.size());
    into.emplace_back(phonemes.substr(0, end));
    phonemes.remove_prefix(std::min(end + 1, phonemes.size()));
  }
}

bool IsVowel(char c) { return kVowelLetters.find(c) != std::string_view::npos; }

/// The letters from `at` on: how many are taken, and what they sound like.
std::size_t Letters(std::string_view word, std::size_t at, PhonemeNames& names) {
  const std::string_view rest = word.substr(at);
  const char next = rest.size() > 1 ? rest[1] : '\0';
  const bool soft = next == 'e' || next == 'i' || next == 'y';
  if (rest == "e" && at > 0 && !names.empty()) return 1;  // silent at the end
  if (rest == "es" && at > 1) return Split("z", names), 2;
  if (rest == "ed" && at > 1) return Split("d", names), 2;
  if (rest == "y") return Split(at > 1 ? "iy" : "ay", names), 1;
  for (const Entry& group : kGroups) {
    if (group.spelling == "ce" && rest != "ce") continue;
    if (rest.starts_with(group.spelling))
      return Split(group.phonemes, names), group.spelling.size();
  }
  if (const std::size_t vowel = kVowelLetters.find(rest[0]); vowel != std::string_view::npos) {
    // Long before one consonant and a silent e, and at the end of the word.
    const bool magic = rest.size() == 3 && !IsVowel(rest[1]) && rest[2] == 'e';
    return Split(magic || rest.size() == 1 ? kLong[vowel] : kShort[vowel], names), 1;
  }
  const std::size_t length = next == rest[0] ? 2 : 1;  // doubled letters sound once
  if (rest[0] == 'c' && soft) return Split("s", names), length;
  if (rest[0] == 'g' && soft) return Split("jh", names), length;
  if (rest[0] == 'y' && at > 0 && !IsVowel(next)) return Split("ih", names), 1;
  for (const Entry& consonant : kConsonants) {
    if (rest[0] == consonant.spelling[0]) return Split(consonant.phonemes, names), length;
  }
  return 1;  // an apostrophe
}

}  // namespace

PhonemeNames FromEnglishWord(std::string_view word) {
  const std::string lower = vm::LowerCase(word);
  PhonemeNames names;
  for (const Entry& entry : kWords) {
    if (entry.spelling == lower) {
      Split(entry.phonemes, names);
      return names;
    }
  }
  for (std::size_t at = 0; at < lower.size();) at += Letters(lower, at, names);
  const bool has_letter = lower.find_first_not_of('\'') != std::string::npos;
  if (names.empty() && has_letter) names.emplace_back("ax");
  return names;
}

bool LooksEnglish(std::string_view lower_case_word) {
  return std::find(std::begin(kEnglishReadableAsRomaji), std::end(kEnglishReadableAsRomaji),
                   lower_case_word) != std::end(kEnglishReadableAsRomaji);
}

PhonemeNames FromDigitEnglish(char digit) {
  static constexpr std::string_view kDigits[] = {"z ih r ow", "w ah n", "t uw",     "th r iy",
                                                 "f ao r",    "f ay v", "s ih k s", "s eh v ax n",
                                                 "ey t",      "n ay n"};
  assert(digit >= '0' && digit <= '9');
  PhonemeNames names;
  Split(kDigits[digit - '0'], names);
  return names;
}

}  // namespace ssm_stub
