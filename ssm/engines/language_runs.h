#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ssm {

/// A part of a text in one language.
struct LanguageRun {
  std::string language;  ///< "en", "ja", "ru", ...
  std::string text;
  bool operator==(const LanguageRun&) const = default;
};

/// Cuts a text where its script says that the language changes. `base` is the language of the
/// speaker: it takes every run its script could be, and digits, signs and blanks go with the run
/// before them. Kana is Japanese; ideographs are `ideographs` unless the base is Chinese; Hangul
/// Korean; Cyrillic, Greek, Arabic, Devanagari their first language (or the base, if it is written
/// so); Latin letters are the base, or English where the base is written otherwise. In Japanese, up
/// to three capitals alone (AI, TV) stay Japanese. Pure.
std::vector<LanguageRun> SplitLanguages(std::string_view text, std::string_view base,
                                        std::string_view ideographs = "ja");

/// The same where somebody has said what language it is: Latin letters and figures are of it, too,
/// where nothing else is written.
std::vector<LanguageRun> SplitAsked(std::string_view text, const std::string& language);

/// What tells Japanese from Chinese in a text.
struct Ideographs {
  bool any = false;
  bool kana = false;  ///< with kana it is Japanese
  bool beyond_japanese =
      false;  ///< one that CP932 (JIS X 0208 and what Japanese vendors added) lacks
};
Ideographs FindIdeographs(std::string_view text);

}  // namespace ssm
