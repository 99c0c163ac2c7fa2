#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ear/grammar/grammar.h"

namespace srm {

/// Several grammars as one in the form the recogniser's engine reads (JSGF), as alternatives of
/// equal weight. Tags are left out (Grammar::Match finds them). Where any word may stand, a loop of
/// all phonemes stands, spelled as the words kPhonemeWord + NAME.
std::string ToJsgf(const std::vector<const ear::Grammar*>& grammars);

inline constexpr std::string_view kPhonemeWord = "PH_";
/// The 39 phonemes of the English model.
const std::vector<std::string>& ModelPhonemes();

}  // namespace srm
