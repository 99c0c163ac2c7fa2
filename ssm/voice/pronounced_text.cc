#include "ssm/voice/pronounced_text.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "embedded/ipa.h"
#include "ssm/voice/samples.h"
#include "ssm/voice/word_signs.h"

namespace ssm {
namespace {

constexpr std::string_view kBegin = "\xEE\x80\x80";
constexpr std::string_view kMiddle = "\xEE\x80\x81";
constexpr std::string_view kEnd = "\xEE\x80\x82";
constexpr std::string_view kNothing = "-";

struct Sign {
  std::string ipa, flite, espeak, sampa;
};

/// Longest first, so that the first that fits is the longest.
const std::vector<Sign>& Signs() {
  static const std::vector<Sign> signs = [] {
    std::vector<Sign> list;
    std::istringstream lines{std::string(embedded::ipa())};
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      Sign sign;
      if (line.starts_with('#') || !(words >> sign.ipa >> sign.flite >> sign.espeak >> sign.sampa))
        continue;
      list.push_back(std::move(sign));
    }
    std::sort(list.begin(), list.end(), [](const Sign& a, const Sign& b) {
      return a.ipa.size() != b.ipa.size() ? a.ipa.size() > b.ipa.size() : a.ipa < b.ipa;
    });
    return list;
  }();
  return signs;
}

/// What may stand between sounds and says nothing to us: dots, ties, blanks.
std::size_t Skipped(std::string_view text) {
  for (const std::string_view sign : {".", " ", "\u0361", "\u035C", "\u200D", "|", "ˑ"}) {
    if (text.starts_with(sign)) return sign.size();
  }
  return 0;
}

/// The signs of a spelling, by one of the table's columns.
vm::Result<std::vector<const Sign*>> Read(std::string_view text, std::string Sign::*column) {
  std::vector<const Sign*> read;
  while (!text.empty()) {
    const Sign* longest = nullptr;
    for (const Sign& sign : Signs()) {
      const std::string& name = sign.*column;
      if (text.starts_with(name) && (!longest || name.size() > (longest->*column).size())) {
        longest = &sign;
      }
    }
    if (longest == nullptr) {
      const std::size_t skipped = Skipped(text);
      if (skipped == 0) {
        return vm::Fail(vm::Errc::kBadValue,
                        "no phoneme is written '" + std::string(text.substr(0, 4)) + "'");
      }
      text.remove_prefix(skipped);
      continue;
    }
    read.push_back(longest);
    text.remove_prefix((longest->*column).size());
  }
  return read;
}

bool IsStress(const Sign& sign) { return sign.flite == "1" || sign.flite == "2"; }

bool IsFliteVowel(const std::string& name) {
  static constexpr std::array<std::string_view, 16> kVowels = {"aa", "ae", "ah", "ao", "aw", "ax",
                                                               "ay", "eh", "er", "ey", "ih", "iy",
                                                               "ow", "oy", "uh", "uw"};
  return std::find(kVowels.begin(), kVowels.end(), name) != kVowels.end();
}

}  // namespace

std::string Pronounced(std::string_view ipa, std::string_view written) {
  return std::string(kBegin) + std::string(ipa) + std::string(kMiddle) + std::string(written) +
         std::string(kEnd);
}

std::string WithoutPronunciationMarks(std::string_view text) {
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view here = text.substr(at, kBegin.size());
    if (here == kBegin || here == kMiddle || here == kEnd) {
      at += here.size();
    } else {
      clean += text[at++];
    }
  }
  return clean;
}

std::vector<TextPiece> CutPronounced(std::string_view text) {
  std::vector<TextPiece> pieces;
  while (!text.empty()) {
    const std::size_t begin = text.find(kBegin);
    const std::size_t middle = begin == text.npos ? begin : text.find(kMiddle, begin);
    const std::size_t end = middle == text.npos ? middle : text.find(kEnd, middle);
    if (end == text.npos) {
      pieces.push_back({WithoutPronunciationMarks(text), ""});
      break;
    }
    if (begin > 0) pieces.push_back({std::string(text.substr(0, begin)), ""});
    const std::size_t ipa = begin + kBegin.size(), written = middle + kMiddle.size();
    pieces.push_back({std::string(text.substr(written, end - written)),
                      std::string(text.substr(ipa, middle - ipa))});
    text.remove_prefix(end + kEnd.size());
  }
  return pieces;
}

std::string AsWritten(std::string_view text) {
  if (!text.contains(kBegin)) return std::string(text);
  std::string written;
  for (const TextPiece& piece : CutPronounced(text)) written += piece.text;
  return written;
}

vm::Result<std::string> IpaForFlite(std::string_view ipa) {
  const auto signs = Read(ipa, &Sign::ipa);
  if (!signs) return std::unexpected(signs.error());
  const bool stressed =
      std::any_of(signs->begin(), signs->end(), [](const Sign* s) { return s->flite == "1"; });
  std::string phonemes;
  std::string stress = stressed ? "0" : "1";  // the first vowel, where nothing is said
  for (const Sign* sign : *signs) {
    if (IsStress(*sign)) {
      stress = "1";
      continue;
    }
    if (sign->flite == kNothing) continue;
    std::string name = sign->flite;
    std::replace(name.begin(), name.end(), '-', ' ');
    if (IsFliteVowel(name)) {
      name += stress;
      stress = "0";
    }
    phonemes += (phonemes.empty() ? "" : " ") + name;
  }
  if (phonemes.empty()) return vm::Fail(vm::Errc::kBadValue, "there is no phoneme");
  return phonemes;
}

vm::Result<std::string> IpaForEspeak(std::string_view ipa) {
  const auto signs = Read(ipa, &Sign::ipa);
  if (!signs) return std::unexpected(signs.error());
  std::string mnemonics;
  bool stressed = false;
  for (const Sign* sign : *signs) {
    stressed = stressed || sign->flite == "1";
    mnemonics += sign->espeak;
  }
  return stressed ? mnemonics : "'" + mnemonics;
}

vm::Result<std::string> IpaOfSampa(std::string_view sampa) {
  const auto signs = Read(sampa, &Sign::sampa);
  if (!signs) return std::unexpected(signs.error());
  std::string ipa;
  for (const Sign* sign : *signs) ipa += sign->ipa;
  return ipa;
}

vm::Result<std::string> IpaOfArpabet(std::string_view arpabet) {
  std::istringstream words{std::string(arpabet)};
  std::string ipa;
  for (std::string word; words >> word;) {
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (word.back() == '1') ipa += "ˈ";
    while (!word.empty() && word.back() >= '0' && word.back() <= '9') word.pop_back();
    const auto& signs = Signs();
    const auto found = std::find_if(signs.begin(), signs.end(),
                                    [&](const Sign& sign) { return sign.flite == word; });
    if (found == signs.end() || word.empty()) {
      return vm::Fail(vm::Errc::kBadValue, "no phoneme is named '" + word + "'");
    }
    ipa += found->ipa;
  }
  if (ipa.empty()) return vm::Fail(vm::Errc::kBadValue, "there is no phoneme");
  return ipa;
}

EnglishText NamePronounced(std::string_view text) {
  if (!text.contains(kBegin)) return {.text = std::string(text)};
  static constexpr std::string_view kConsonants = "bdfgklmnprstvz";
  EnglishText english;
  bool named = false;  // a made-up word was the last
  for (const TextPiece& piece : CutPronounced(text)) {
    if (std::exchange(named, false) && IsWordSign(FirstSign(piece.text))) english.text += ' ';
    const auto phonemes = IpaForFlite(piece.ipa);  // (an error where there is none)
    if (!phonemes) {
      english.text += piece.text;
      continue;
    }
    // Made to look like a word, else it is spelled letter by letter.
    const std::size_t number = english.made.size();
    const std::size_t most = kConsonants.size();
    const std::string name = std::string("za") + kConsonants[number % most] + "o" +
                             kConsonants[number / most % most] + "ova";
    english.made.push_back({name, piece.text, *phonemes});
    // With letters beside it the word would not be found in the lexicon.
    if (IsWordSign(LastSign(english.text))) english.text += ' ';
    english.text += name;
    named = true;
  }
  return english;
}

}  // namespace ssm
