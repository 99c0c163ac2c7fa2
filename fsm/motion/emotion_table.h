#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/action_units.h"

namespace fsm {

/// An emotion: its looks by pattern number, and how it comes about.
struct Emotion {
  std::vector<ActionUnits> patterns;  ///< at full strength; pattern 1 is patterns[0]
  /// Of each pattern, the strength from which on a unit takes part, 0..0.9: a slight smile is shut.
  std::vector<ActionUnits> begins;
  /// How it comes about: ms from neutral to the peak, and by how much each part of the face begins
  /// later than the first.
  struct Timing {
    double onset_ms = 450;
    std::array<double, kRegions> lag_ms{0, 8, 14};
  };
  Timing posed;     ///< shown on purpose
  Timing elicited;  ///< felt

  /// What a pattern looks like at a strength. REQUIRES: there is that pattern.
  ActionUnits LookAt(int pattern, double strength) const;
  /// Makes or changes a pattern; all of it takes part from the start. REQUIRES: 1 or more.
  void Redefine(std::size_t pattern, const ActionUnits& look);
};
using EmotionTable = std::map<std::string, Emotion, std::less<>>;
/// Looks of whole expressions by FaceExp's name and pattern number.
using ExpressionLooks = std::map<std::string, std::map<int, ActionUnits>>;

/// Reads tables/emotions.txt: every emotion needs its patterns numbered from 1 without gaps.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<EmotionTable> ReadEmotions(const std::string& name, std::string_view text,
                                      const UnitNames& names);

}  // namespace fsm
