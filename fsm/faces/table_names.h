#pragma once

#include <array>
#include <string_view>

namespace fsm {

/// The tables of heads and of what they look like that a TableFolder can replace, beside those of
/// MotionTables.
inline constexpr std::array<std::string_view, 3> kHeadTables = {"action_units.txt",
                                                                "appearance.txt", "features.txt"};
inline constexpr std::string_view kUnitsTable = kHeadTables[0], kAppearanceTable = kHeadTables[1],
                                  kFeaturesTable = kHeadTables[2];

}  // namespace fsm
