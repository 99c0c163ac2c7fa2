#pragma once

#include <cstddef>

/// What a grammar may cost. Whatever is beyond one of these is refused by an error that names the
/// rule and the limit, before memory or time is spent on it (docs/speech.md has the same table).
namespace ear {

// The source.
inline constexpr std::size_t kMaxGrammarBytes = 1u << 20;
inline constexpr std::size_t kMaxParts = 50'000;     ///< words, tags, references, groups as written
inline constexpr std::size_t kMaxWordBytes = 200;    ///< of one word
inline constexpr int kMaxNesting = 64;               ///< brackets or elements inside each other
inline constexpr std::size_t kMaxRuleNesting = 100;  ///< rules inside rules, recursion not counted
inline constexpr int kMaxRepeat = 1000;

// What it stands for when every repeat and every rule in it is written out, as an engine does.
inline constexpr std::size_t kMaxExpandedParts = 50'000;
inline constexpr std::size_t kMaxExpandedBytes = std::size_t{4} << 20;  ///< of words and tags

// Matching. A text beyond one of these fits no grammar.
inline constexpr std::size_t kMaxMatchBytes = 4096;  ///< of words, without what is between
inline constexpr std::size_t kMaxMatchSteps = 2'000'000;
inline constexpr int kMaxMatchNesting = 1000;  ///< rules inside rules, recursion counted
inline constexpr std::size_t kMaxMeaningBytes = 65'536;

}  // namespace ear
