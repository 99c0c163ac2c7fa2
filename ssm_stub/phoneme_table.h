#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace ssm_stub {

using Millis = std::chrono::milliseconds;

/// How long a phoneme lasts at normal speed; kOtherPhoneme for a name that is not in the table.
Millis PhonemeLength(std::string_view name);
inline constexpr Millis kOtherPhoneme{70};

/// The pause a punctuation character makes; zero if it makes none.
Millis PauseOf(char32_t sign);
inline constexpr Millis kEdgePause{100};  ///< before the first phoneme and after the last

/// Text as code points. A byte that is no UTF-8 becomes U+FFFD.
std::u32string Decode(std::string_view utf8);
std::string Encode(std::u32string_view text);

}  // namespace ssm_stub
