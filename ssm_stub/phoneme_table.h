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

}  // namespace ssm_stub
