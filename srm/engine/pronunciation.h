#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace srm {

/// How a word may be said, each way as phonemes of the English model with blanks between. Kana by
/// table (devoiced and shortened variants included; experimental), digits by their English words,
/// Latin words by flite's dictionary and letter-to-sound rules. Empty if it has no letter we know.
/// Thread: any; flite's rules are read once and constant afterwards.
std::vector<std::string> PronunciationsOf(std::string_view word);

/// "15" -> "fifteen", up to 999999; digit by digit beyond. REQUIRES: digits only.
std::string NumberWords(std::string_view digits);

bool IsKana(std::string_view word);

}  // namespace srm
