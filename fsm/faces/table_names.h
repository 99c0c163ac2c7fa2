#pragma once

#include <array>
#include <string_view>

namespace fsm {

inline constexpr std::string_view kUnitsTable = "action_units.txt",
                                  kUnitNamesTable = "action_unit_names.txt",
                                  kFeaturesTable = "features.txt",
                                  kAppearanceTable = "appearance.txt";

/// The tables of motion, head and render that a TableFolder can replace, in alphabetical order.
inline constexpr auto kTableNames = std::to_array<std::string_view>(
    {"action_unit_list.txt", kUnitNamesTable,       kUnitsTable,
     kAppearanceTable,       "arkit.txt",           "dominance.txt",
     "emotion_space.txt",    "emotions.txt",        kFeaturesTable,
     "gestures.txt",         "mixing.txt",          "motions.txt",
     "mouth_shapes.txt",     "mouth_shapes_28.txt", "phoneme_names.txt",
     "phonemes28_en.txt",    "phonemes28_ja.txt",   "phonemes_en.txt",
     "phonemes_ja.txt",      "text_cues.txt"});

}  // namespace fsm
