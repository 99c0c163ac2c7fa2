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

/// The most parts in a row that may all be left out, with repeats written out. The engine links
/// everything before such a row to everything in and behind it, in time that grows with more than
/// the cube of this: 100 of them took it 0.04 s, 300 took 6 s.
std::size_t LongestOptionalRow(const ear::Grammar& grammar);
inline constexpr std::size_t kMaxOptionalRow = 200;

inline constexpr std::string_view kPhonemeWord = "PH_";
/// The 39 phonemes of the English model.
const std::vector<std::string>& ModelPhonemes();

}  // namespace srm
