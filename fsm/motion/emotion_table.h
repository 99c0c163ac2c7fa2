#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/action_unit_table.h"

namespace fsm {

/// An emotion: its looks by pattern number, and how it comes about.
struct Emotion {
  std::vector<ActionUnits> patterns;      ///< pattern 1 is patterns[0]
  double onset_ms = 400;                  ///< from neutral to the peak
  std::array<double, kRegions> lag_ms{};  ///< by how much each part of the face begins later
};
using EmotionTable = std::map<std::string, Emotion, std::less<>>;

/// Every emotion needs its patterns numbered from 1 without gaps.
vm::Result<EmotionTable> ReadEmotions(const std::string& name, std::string_view text);

}  // namespace fsm
