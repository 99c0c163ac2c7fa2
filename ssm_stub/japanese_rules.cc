#include "ssm_stub/japanese_rules.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace ssm_stub {
namespace {

struct Mora {
  std::string consonant;  // may be empty
  std::string vowel;      // empty for N and cl, which stand in `consonant`
};

struct Row {
  std::u32string_view kana;  // one character for each of the vowels a i u e o; '-' for none
  std::array<std::string_view, 5> consonants;
};

constexpr std::array<std::string_view, 5> kVowels = {"a", "i", "u", "e", "o"};
constexpr Row kRows[] = {
    {U"あいうえお", {"", "", "", "", ""}},      {U"かきくけこ", {"k", "k", "k", "k", "k"}},
    {U"がぎぐげご", {"g", "g", "g", "g", "g"}}, {U"さしすせそ", {"s", "sh", "s", "s", "s"}},
    {U"ざじずぜぞ", {"z", "j", "z", "z", "z"}}, {U"たちつてと", {"t", "ch", "ts", "t", "t"}},
    {U"だぢづでど", {"d", "j", "z", "d", "d"}}, {U"なにぬねの", {"n", "n", "n", "n", "n"}},
    {U"はひふへほ", {"h", "h", "f", "h", "h"}}, {U"ばびぶべぼ", {"b", "b", "b", "b", "b"}},
    {U"ぱぴぷぺぽ", {"p", "p", "p", "p", "p"}}, {U"まみむめも", {"m", "m", "m", "m", "m"}},
    {U"や-ゆ-よ", {"y", "", "y", "", "y"}},     {U"らりるれろ", {"r", "r", "r", "r", "r"}},
    {U"わゐ-ゑを", {"w", "", "", "", ""}},      {U"--ゔ--", {"", "", "b", "", ""}}};
constexpr std::u32string_view kSmallVowels = U"ぁぃぅぇぉ";
constexpr std::u32string_view kSmallY = U"ゃ-ゅ-ょ";

// Consonants as romaji writes them, longest first, with the phoneme each is.
struct Onset {
  std::u32string_view letters;
  std::string_view phoneme;
  std::u32string_view before;  // the vowels it takes in this reading
};
constexpr Onset kOnsets[] = {
    {U"tsu", "ts", U"*"},  // see FromRomaji: these three carry their vowel with them
    {U"shi", "sh", U"*"},  {U"chi", "ch", U"*"},  {U"sh", "sh", U"aueo"}, {U"ch", "ch", U"aueo"},
    {U"ky", "ky", U"auo"}, {U"gy", "gy", U"auo"}, {U"sy", "sh", U"auo"},  {U"jy", "j", U"auo"},
    {U"zy", "j", U"auo"},  {U"ty", "ch", U"auo"}, {U"ny", "ny", U"auo"},  {U"hy", "hy", U"auo"},
    {U"by", "by", U"auo"}, {U"py", "py", U"auo"}, {U"my", "my", U"auo"},  {U"ry", "ry", U"auo"},
    {U"k", "k", U"aiueo"}, {U"g", "g", U"aiueo"}, {U"s", "sh", U"i"},     {U"s", "s", U"aueo"},
    {U"z", "j", U"i"},     {U"z", "z", U"aueo"},  {U"j", "j", U"aiuo"},   {U"t", "ch", U"i"},
    {U"t", "ts", U"u"},    {U"t", "t", U"aeo"},   {U"d", "d", U"aeo"},    {U"n", "n", U"aiueo"},
    {U"h", "f", U"u"},     {U"h", "h", U"aieo"},  {U"f", "f", U"u"},      {U"b", "b", U"aiueo"},
    {U"p", "p", U"aiueo"}, {U"m", "m", U"aiueo"}, {U"y", "y", U"auo"},    {U"r", "r", U"aiueo"},
    {U"w", "w", U"a"},     {U"", "", U"aiueo"}};

char32_t ToHiragana(char32_t c) { return c >= U'ァ' && c <= U'ヴ' ? c - (U'ァ' - U'ぁ') : c; }

/// Palatal: k -> ky; sh, ch, j have it in them.
std::string Palatal(const std::string& consonant) {
  if (consonant.empty() || consonant == "sh" || consonant == "ch" || consonant == "j") {
    return consonant.empty() ? "y" : consonant;
  }
  return consonant + "y";
}

PhonemeNames Flatten(const std::vector<Mora>& morae) {
  PhonemeNames names;
  for (const Mora& mora : morae) {
    if (!mora.consonant.empty()) names.push_back(mora.consonant);
    if (!mora.vowel.empty()) names.push_back(mora.vowel);
  }
  return names;
}

/// Small letters and ー change or continue the mora before them. True if `c` was one.
bool Continue(std::vector<Mora>& morae, char32_t c) {
  if (c == U'ー') {
    if (!morae.empty() && !morae.back().vowel.empty()) morae.push_back({"", morae.back().vowel});
    return true;
  }
  const bool after_mora = !morae.empty() && !morae.back().vowel.empty();
  if (const std::size_t v = kSmallY.find(c); v != std::u32string_view::npos && c != U'-') {
    if (after_mora) {
      morae.back() = {Palatal(morae.back().consonant), std::string(kVowels[v])};
    } else {
      morae.push_back({"y", std::string(kVowels[v])});
    }
    return true;
  }
  if (const std::size_t v = kSmallVowels.find(c); v != std::u32string_view::npos) {
    const std::string vowel(kVowels[v]);
    if (!after_mora) {
      morae.push_back({"", vowel});
    } else if (!morae.back().consonant.empty()) {
      morae.back().vowel = vowel;  // ふぁ, てぃ, しぇ
    } else if (morae.back().vowel == "u") {
      morae.back() = {"w", vowel};  // うぃ
    } else {
      morae.push_back({"", vowel});  // ああぁ
    }
    return true;
  }
  return false;
}

char32_t LowerPlain(char32_t c, bool& is_long) {
  static constexpr std::u32string_view kMacron = U"āīūēōâîûêô";
  static constexpr std::u32string_view kPlain = U"aiueo";
  if (c >= U'A' && c <= U'Z') return c + (U'a' - U'A');
  static constexpr std::u32string_view kMacronCapital = U"ĀĪŪĒŌÂÎÛÊÔ";
  std::size_t at = kMacron.find(c);
  if (at == std::u32string_view::npos) at = kMacronCapital.find(c);
  if (at == std::u32string_view::npos) return c;
  is_long = true;
  return kPlain[at % kPlain.size()];
}

bool IsVowel(char32_t c) {
  return std::u32string_view(U"aiueo").find(c) != std::u32string_view::npos;
}

}  // namespace

bool IsKana(char32_t c) {
  return (c >= U'ぁ' && c <= U'ゔ') || (c >= U'ァ' && c <= U'ヴ') || c == U'ー' || c == U'ヵ' ||
         c == U'ヶ';
}

PhonemeNames FromKana(std::u32string_view kana) {
  std::vector<Mora> morae;
  for (const char32_t written : kana) {
    const char32_t c = written == U'ヵ' ? U'か' : written == U'ヶ' ? U'け' : ToHiragana(written);
    if (c == U'っ') {
      morae.push_back({"cl", ""});
    } else if (c == U'ん') {
      morae.push_back({"N", ""});
    } else if (c == U'ゎ') {
      morae.push_back({"w", "a"});
    } else if (!Continue(morae, c)) {
      for (const Row& row : kRows) {
        const std::size_t v = row.kana.find(c);
        if (v != std::u32string_view::npos) {
          morae.push_back({std::string(row.consonants[v]), std::string(kVowels[v])});
        }
      }
    }
  }
  return Flatten(morae);
}

std::optional<PhonemeNames> FromRomaji(std::u32string_view word) {
  std::u32string letters;
  for (const char32_t written : word) {
    bool is_long = false;
    const char32_t c = LowerPlain(written, is_long);
    letters += c;
    if (is_long) letters += c;
  }
  std::vector<Mora> morae;
  for (std::size_t at = 0; at < letters.size();) {
    const std::u32string_view rest = std::u32string_view(letters).substr(at);
    const char32_t next = rest.size() > 1 ? rest[1] : 0;
    if (rest[0] == U'n' && !IsVowel(next) && next != U'y') {
      morae.push_back({"N", ""});
      at += next == U'\'' ? 2 : 1;
      continue;
    }
    const bool doubled = rest[0] == next || (rest[0] == U't' && next == U'c');
    if (doubled && std::u32string_view(U"kstpgzdbcjf").find(rest[0]) != std::u32string_view::npos) {
      morae.push_back({"cl", ""});
      ++at;
      continue;
    }
    bool found = false;
    for (const Onset& onset : kOnsets) {
      if (!rest.starts_with(onset.letters)) continue;
      const bool whole = onset.before == U"*";
      const std::size_t vowel_at = onset.letters.size() - (whole ? 1 : 0);
      if (vowel_at >= rest.size()) continue;
      if (!whole && onset.before.find(rest[vowel_at]) == std::u32string_view::npos) continue;
      morae.push_back(
          {std::string(onset.phoneme), std::string(1, static_cast<char>(rest[vowel_at]))});
      at += vowel_at + 1;
      found = true;
      break;
    }
    if (!found) return std::nullopt;
  }
  return Flatten(morae);
}

PhonemeNames FromDigitJapanese(char32_t digit) {
  static constexpr std::u32string_view kNames[] = {U"ぜろ", U"いち", U"に",   U"さん", U"よん",
                                                   U"ご",   U"ろく", U"なな", U"はち", U"きゅう"};
  assert(digit >= U'0' && digit <= U'9');
  return FromKana(kNames[digit - U'0']);
}

PhonemeNames UnreadablePhonemes() { return {"a", "u"}; }

}  // namespace ssm_stub
