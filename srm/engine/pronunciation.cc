#include "srm/engine/pronunciation.h"

extern "C" {
#include <flite/flite.h>
cst_lexicon* cmu_lex_init(void);
}

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>

#include "ear/grammar/grammar_limits.h"
#include "vm_protocol/core/utf8.h"

namespace srm {
namespace {

// U+30A1 to U+30F6 as phonemes of the English model. "_": joins the mora before it.
constexpr std::array<std::string_view, 86> kKana = {
    "_AA",   "AA",    "_IY",    "IY",    "_UW",  "UW",    "_EH",  "EH",   "_AO",  "AO",   "K AA",
    "G AA",  "K IY",  "G IY",   "K UW",  "G UW", "K EH",  "G EH", "K AO", "G AO", "S AA", "Z AA",
    "SH IY", "JH IY", "S UW",   "Z UW",  "S EH", "Z EH",  "S AO", "Z AO", "T AA", "D AA", "CH IY",
    "JH IY", "",      "T S UW", "Z UW",  "T EH", "D EH",  "T AO", "D AO", "N AA", "N IY", "N UW",
    "N EH",  "N AO",  "HH AA",  "B AA",  "P AA", "HH IY", "B IY", "P IY", "F UW", "B UW", "P UW",
    "HH EH", "B EH",  "P EH",   "HH AO", "B AO", "P AO",  "M AA", "M IY", "M UW", "M EH", "M AO",
    "_YAA",  "Y AA",  "_YUW",   "Y UW",  "_YAO", "Y AO",  "R AA", "R IY", "R UW", "R EH", "R AO",
    "W AA",  "W AA",  "IY",     "EH",    "AO",   "N",     "V UW", "K AA", "K EH"};

using Phones = std::vector<std::string>;

bool IsVowel(const std::string& phone) {
  return phone == "AA" || phone == "IY" || phone == "UW" || phone == "EH" || phone == "AO";
}

void Append(Phones& phones, std::string_view names) {
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(' '), names.size());
    phones.emplace_back(names.substr(0, end));
    names.remove_prefix(std::min(end + 1, names.size()));
  }
}

void JoinSmall(Phones& phones, std::string_view small) {
  const bool glide = small[0] == 'Y';
  const std::string vowel(small.substr(glide ? 1 : 0));
  const bool replaces =
      phones.size() >= 2 && IsVowel(phones.back()) && !IsVowel(phones[phones.size() - 2]);
  if (!replaces) {
    if (!phones.empty() && phones.back() == "UW" && !glide) phones.back() = "W";
    phones.push_back(vowel);
    return;
  }
  const std::string& consonant = phones[phones.size() - 2];
  const bool sharp = consonant == "SH" || consonant == "CH" || consonant == "JH";
  phones.pop_back();
  if (glide && !sharp) phones.push_back("Y");
  phones.push_back(vowel);
}

Phones KanaPhones(std::string_view kana, bool long_vowels) {
  Phones phones;
  for (char32_t code : vm::SignsOf(kana)) {
    if (code >= 0x3041 && code <= 0x3096) code += 0x60;
    if (code == 0x30FC) {
      if (long_vowels && !phones.empty() && IsVowel(phones.back())) phones.push_back(phones.back());
    } else if (code >= 0x30A1 && code <= 0x30F6) {
      const std::string_view name = kKana[code - 0x30A1];
      name.starts_with('_') ? JoinSmall(phones, name.substr(1)) : Append(phones, name);
    }
  }
  return phones;
}

/// Between voiceless sounds, or at the end after one, i and u may be silent.
Phones Devoiced(const Phones& phones) {
  static constexpr std::string_view kVoiceless = " K S SH T CH HH F P ";
  const auto voiceless = [&](std::size_t i) {
    return i >= phones.size() || kVoiceless.contains(" " + phones[i] + " ");
  };
  Phones result;
  for (std::size_t i = 0; i < phones.size(); ++i) {
    const bool high = phones[i] == "IY" || phones[i] == "UW";
    if (high && i > 0 && voiceless(i - 1) && voiceless(i + 1)) continue;
    result.push_back(phones[i]);
  }
  return result;
}

std::string Joined(const Phones& phones) {
  std::string text;
  for (const std::string& phone : phones) text += (text.empty() ? "" : " ") + phone;
  return text;
}

void AddOnce(std::vector<std::string>& all, std::string text) {
  for (const std::string& one : all) {
    if (one == text) return;
  }
  if (!text.empty()) all.push_back(std::move(text));
}

std::vector<std::string> KanaPronunciations(std::string_view word) {
  std::vector<std::string> all;
  for (const bool long_vowels : {true, false}) {
    const Phones phones = KanaPhones(word, long_vowels);
    AddOnce(all, Joined(phones));
    AddOnce(all, Joined(Devoiced(phones)));
  }
  return all;
}

/// flite's phonemes in the model's spelling: no stress, ax is AH.
std::string LatinPronunciation(const std::string& word) {
  if (word.size() > ear::kMaxWordBytes) return {};  // flite's rules take the stack for each letter
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  static cst_lexicon* lexicon = cmu_lex_init();
  cst_val* found = lex_lookup(lexicon, word.c_str(), nullptr, nullptr);
  std::string phones;
  for (const cst_val* v = found; v != nullptr; v = val_cdr(v)) {
    std::string name = val_string(val_car(v));
    while (!name.empty() && name.back() >= '0' && name.back() <= '9') name.pop_back();
    for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    if (name == "AX") name = "AH";
    if (!name.empty()) phones += (phones.empty() ? "" : " ") + name;
  }
  delete_val(found);
  return phones;
}

std::string Below1000(unsigned long number) {
  static constexpr const char* kSmall[] = {
      "",         "one",     "two",     "three",     "four",     "five",    "six",
      "seven",    "eight",   "nine",    "ten",       "eleven",   "twelve",  "thirteen",
      "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"};
  static constexpr const char* kTens[] = {"",      "",      "twenty",  "thirty", "forty",
                                          "fifty", "sixty", "seventy", "eighty", "ninety"};
  std::string text;
  if (number >= 100) text = std::string(kSmall[number / 100]) + " hundred";
  number %= 100;
  const auto add = [&](const char* word) {
    if (*word != '\0') text += (text.empty() ? "" : " ") + std::string(word);
  };
  if (number >= 20) add(kTens[number / 10]);
  add(kSmall[number >= 20 ? number % 10 : number]);
  return text;
}

}  // namespace

bool IsKana(std::string_view word) {
  const std::u32string signs = vm::SignsOf(word);
  return !signs.empty() &&
         std::ranges::all_of(signs, [](char32_t c) { return c >= 0x3040 && c <= 0x30FF; });
}

std::string NumberWords(std::string_view digits) {
  static constexpr const char* kDigits[] = {"zero", "one", "two",   "three", "four",
                                            "five", "six", "seven", "eight", "nine"};
  if (digits.size() > 6 || (digits.size() > 1 && digits[0] == '0')) {
    std::string text;
    for (const char c : digits) text += (text.empty() ? "" : " ") + std::string(kDigits[c - '0']);
    return text;
  }
  const unsigned long number = std::strtoul(std::string(digits).c_str(), nullptr, 10);
  if (number == 0) return kDigits[0];
  std::string text = number >= 1000 ? Below1000(number / 1000) + " thousand" : "";
  if (number % 1000 != 0) text += (text.empty() ? "" : " ") + Below1000(number % 1000);
  return text;
}

std::vector<std::string> PronunciationsOf(std::string_view word) {
  if (IsKana(word)) return KanaPronunciations(word);
  std::string letters;
  Phones phones;
  const auto flush = [&] {
    if (letters.empty()) return;
    const bool number = letters[0] >= '0' && letters[0] <= '9';
    const std::string words = number ? NumberWords(letters) : letters;
    for (std::size_t at = 0; at < words.size();) {
      const std::size_t end = std::min(words.find(' ', at), words.size());
      Append(phones, LatinPronunciation(words.substr(at, end - at)));
      at = end + 1;
    }
    letters.clear();
  };
  for (const char raw : word) {
    const char c = raw >= 'A' && raw <= 'Z' ? static_cast<char>(raw - 'A' + 'a') : raw;
    const bool digit = c >= '0' && c <= '9';
    if (!digit && !(c >= 'a' && c <= 'z') && c != '\'') {
      flush();
      continue;
    }
    if (!letters.empty() && digit != (letters[0] >= '0' && letters[0] <= '9')) flush();
    letters += c;
  }
  flush();
  return phones.empty() ? std::vector<std::string>() : std::vector<std::string>{Joined(phones)};
}

}  // namespace srm
