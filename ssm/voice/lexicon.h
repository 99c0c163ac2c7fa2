#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace ssm {

/// Words with a pronunciation of their own: a document of the W3C's Pronunciation Lexicon
/// Specification 1.0 (<lexicon alphabet="ipa"><lexeme><grapheme>, <phoneme> or <alias>). Of several
/// phonemes or aliases the one with prefer="true" counts, else the first.
class Lexicon {
 public:
  static constexpr std::size_t kMaxEntries = 20'000;
  static constexpr std::size_t kMaxGrapheme = 120;  ///< bytes
  static constexpr std::size_t kMaxSaid = 1000;     ///< bytes of an alias or pronunciation

  struct Entry {
    std::string grapheme{};
    std::string ipa{};    ///< "" where there is an alias
    std::string alias{};  ///< what is said instead
  };

  /// Errors: kSyntax "NAME:LINE:COLUMN: ...", kLimit.
  static vm::Result<Lexicon> Parse(std::string_view xml, const std::string& name);

  /// The longest entry that stands at byte `at` of a text as a word by itself; null if none does.
  const Entry* Find(std::string_view text, std::size_t at) const;

 private:
  std::map<std::string, Entry, std::less<>> entries_;  ///< by grapheme; of several the first
  std::size_t longest_ = 0;                            ///< bytes of a grapheme
};

}  // namespace ssm
