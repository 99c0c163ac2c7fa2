#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ssm {

/// Text as an English engine reads it.
struct AsciiText {
  std::string text;      ///< printable ASCII and blanks only
  std::string left_out;  ///< the first few characters that have no spelling there; empty = none
};

/// Writes typographic signs, accented Latin letters, full-width forms and Japanese punctuation in
/// ASCII; what else is not ASCII becomes a blank and is named. Words of more than kMaxWordBytes are
/// cut by blanks, since the engine's rules were never meant for them.
AsciiText ToAscii(std::string_view utf8);

inline constexpr std::size_t kMaxWordBytes = 60;

/// Cuts a text into sentences: after . ! ? and a blank, if what follows does not begin in lower
/// case and what precedes is no short title (Mr. Dr. e.g.). Long ones are cut at a comma or blank.
std::vector<std::string> SplitSentences(std::string_view ascii);

inline constexpr std::size_t kMaxSentenceBytes = 500;

}  // namespace ssm
