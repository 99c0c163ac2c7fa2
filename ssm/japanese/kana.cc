#include "ssm/japanese/kana.h"

#include <array>

#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

// U+30A1 to U+30F6 in order. Small vowels and ya, yu, yo stand with their sign only; see Join.
constexpr std::array<std::string_view, 86> kNames = {
    "_a",  "a",   "_i",  "i",   "_u",  "u",   "_e",   "e",   "_o",  "o",    "k a", "g a", "k i",
    "g i", "k u", "g u", "k e", "g e", "k o", "g o",  "s a", "z a", "sh i", "j i", "s u", "z u",
    "s e", "z e", "s o", "z o", "t a", "d a", "ch i", "j i", "cl",  "ts u", "z u", "t e", "d e",
    "t o", "d o", "n a", "n i", "n u", "n e", "n o",  "h a", "b a", "p a",  "h i", "b i", "p i",
    "f u", "b u", "p u", "h e", "b e", "p e", "h o",  "b o", "p o", "m a",  "m i", "m u", "m e",
    "m o", "_ya", "y a", "_yu", "y u", "_yo", "y o",  "r a", "r i", "r u",  "r e", "r o", "w a",
    "w a", "i",   "e",   "o",   "N",   "b u", "k a",  "k e"};

using Names = std::vector<std::string>;

bool IsVowel(std::string_view name) {
  return name.size() == 1 && std::string_view("aiueo").contains(name[0]);
}

void Append(Names& names, std::string_view morae) {
  while (!morae.empty()) {
    const std::size_t end = std::min(morae.find(' '), morae.size());
    names.emplace_back(morae.substr(0, end));
    morae.remove_prefix(std::min(end + 1, morae.size()));
  }
}

/// A small kana changes the mora before it: キ + ャ = ky a, シ + ャ = sh a, フ + ァ = f a.
void Join(Names& names, std::string_view small) {
  const bool glide = small.size() == 3;  // _ya _yu _yo
  const std::string vowel(small.substr(small.size() - 1));
  if (names.empty() || !IsVowel(names.back()) || names.size() < 2 ||
      IsVowel(names[names.size() - 2])) {
    // ウィ, ウェ and the like have a w; a lone one is its vowel.
    if (!glide && !names.empty() && names.back() == "u") names.back() = "w";
    if (glide) names.push_back("y");
    names.push_back(vowel);
    return;
  }
  std::string& consonant = names[names.size() - 2];
  const bool sharp = consonant == "sh" || consonant == "ch" || consonant == "j";
  if (glide && !sharp) {
    static constexpr std::string_view kTakeY = "kgnhbpmrd";
    if (consonant.size() == 1 && kTakeY.contains(consonant[0])) consonant += 'y';
  }
  names.back() = vowel;
}

}  // namespace

std::vector<std::string> KanaToPhonemes(std::string_view kana) {
  Names names;
  for (char32_t code : vm::SignsOf(kana)) {
    if (code >= 0x3041 && code <= 0x3096) code += 0x60;  // hiragana
    if (code == 0x30FC) {
      if (!names.empty() && IsVowel(names.back())) names.push_back(std::string(names.back()));
    } else if (code >= 0x30A1 && code <= 0x30F6) {
      const std::string_view name = kNames[code - 0x30A1];
      name.starts_with('_') ? Join(names, name) : Append(names, name);
    }
  }
  return names;
}

}  // namespace ssm
