#pragma once

#include <string_view>

#include "ssm_stub/japanese_rules.h"

namespace ssm_stub {

/// One English word, letters and apostrophes only, as flite's phoneme names: a short list of
/// common words, else letter rules, longest match first. Never empty for a word with a letter.
PhonemeNames FromEnglishWord(std::string_view word);

/// True for common English words which could be read as romaji ("see", "you", "name").
bool LooksEnglish(std::string_view lower_case_word);

/// "7" -> s eh v ax n. REQUIRES: '0' to '9'.
PhonemeNames FromDigitEnglish(char digit);

}  // namespace ssm_stub
