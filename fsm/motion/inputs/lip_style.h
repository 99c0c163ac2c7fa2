#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace fsm {

enum class Language {
  kAuto,  ///< detected from the names in the list
  kJapanese,
  kEnglish,
};

/// The sets of visemes, named by their counts: that of the original, and that of the English and
/// Japanese translation system.
enum class VisemeSetId { k14 = 14, k28 = 28 };
inline constexpr std::array kVisemeSets = {VisemeSetId::k14, VisemeSetId::k28};
constexpr std::size_t CountOf(VisemeSetId set) { return static_cast<std::size_t>(set); }
constexpr std::optional<VisemeSetId> SetOfCount(std::size_t count) {
  const auto* const found = std::ranges::find(kVisemeSets, count, CountOf);
  return found == kVisemeSets.end() ? std::nullopt : std::optional(*found);
}

/// The interpolation of the lips between sounds.
enum class LipMode {
  kDominance,  ///< overlapping dominance curves with anticipation
  kSinusoid,   ///< that of the original: key visemes joined by half a cosine
  kLinear,     ///< key visemes joined by straight lines, for comparison
};

/// How utterances are articulated; a change applies from the next utterance on.
struct LipStyle {
  LipMode mode = LipMode::kDominance;
  VisemeSetId visemes = VisemeSetId::k28;
  Language language = Language::kAuto;
  std::string engine = "AUTO";  ///< whose phoneme names are used, see VisemeFinder
  double jaw = 1;               ///< factor on the jaw's opening, 0 (mumbled) .. 3
  double lips = 1;              ///< factor on the lips' movements, 0..3
};

}  // namespace fsm
