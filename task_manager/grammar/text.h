#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/utf8.h"

namespace vxml::srgs {

/// What tokens and input are compared by: blanks collapsed to one, letters composed and without
/// case (Unicode's full case folding), full-width letters and figures as ASCII's, punctuation at
/// the ends of words dropped.
std::string Fold(std::string_view text);
/// The keys that folded text names, without blanks: "1 star pound" -> "1*#" (SRGS 1.0 appendix E).
std::string FoldKeys(std::string_view folded);

/// Writing without blanks between words: kana, kanji, hangul, full-width forms.
bool IsUnspaced(char32_t c);
/// The code point that ends before `end`; 0 at the start.
char32_t DecodeBefore(std::string_view text, std::size_t end);

}  // namespace vxml::srgs
