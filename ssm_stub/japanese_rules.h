#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ssm_stub {

using PhonemeNames = std::vector<std::string>;

bool IsKana(char32_t c);  ///< hiragana, katakana, or the long mark

/// A run of kana as phonemes: や-combinations (きゃ ky a), small vowels (ふぁ f a), っ cl, ん N,
/// ー the vowel before once more. Nothing is analysed: は is h a, おう is o u.
PhonemeNames FromKana(std::u32string_view kana);

/// One word of Latin letters read as Hepburn or kunrei romaji ("konnichiwa", "shin'ei", "Tōkyō");
/// none if any part of it is not romaji.
std::optional<PhonemeNames> FromRomaji(std::u32string_view word);

/// A digit's Japanese name as phonemes. REQUIRES: '0' to '9'.
PhonemeNames FromDigitJapanese(char32_t digit);

/// What stands for a character without a reading (kanji): two morae, so that the time and the
/// movement of the mouth are about right.
PhonemeNames UnreadablePhonemes();

}  // namespace ssm_stub
