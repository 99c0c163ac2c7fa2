#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

/// Words inside a text that have a pronunciation of their own (SSML's <phoneme>). In a span's text
/// such a word stands as U+E000 IPA U+E001 WRITTEN U+E002, signs that no text has: the words around
/// it stay one sentence with it.
namespace ssm {

std::string Pronounced(std::string_view ipa, std::string_view written);
/// A text from outside, without those three signs.
std::string WithoutPronunciationMarks(std::string_view text);
/// The text as it is written.
std::string AsWritten(std::string_view text);

/// A text cut at such words; `ipa` is empty for what is between them.
struct TextPiece {
  std::string text{};
  std::string ipa{};
};
std::vector<TextPiece> CutPronounced(std::string_view text);

/// IPA for an engine, by ssm/tables/ipa.txt; the longest name counts. Syllable dots, ties and
/// blanks are left out. Errors: kBadValue naming the first sign that is not in the table.
vm::Result<std::string> IpaForFlite(std::string_view ipa);   ///< "hh ax l ow1"
vm::Result<std::string> IpaForEspeak(std::string_view ipa);  ///< mnemonics: "h@l'oU"
/// X-SAMPA, and ARPAbet with blanks between, as IPA.
vm::Result<std::string> IpaOfSampa(std::string_view sampa);
vm::Result<std::string> IpaOfArpabet(std::string_view arpabet);

/// Pronounced words replaced by made-up ones that a lexicon can hold.
struct EnglishText {
  struct Made {
    std::string name{};
    std::string written{};
    std::string phonemes{};  ///< flite's
  };
  std::string text{};
  std::vector<Made> made{};
};
/// A word whose IPA cannot be read stands as it is written. Letters and figures directly beside a
/// pronounced word are parted from it by a blank.
EnglishText NamePronounced(std::string_view text);

}  // namespace ssm
