#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ssm {

/// Kana as the 42 phoneme names of the original voice module: キョー ky o o, ガッコ g a cl k o, ん
/// N. A long mark repeats the vowel before it. What is no kana is left out. Pure.
std::vector<std::string> KanaToPhonemes(std::string_view kana);

}  // namespace ssm
