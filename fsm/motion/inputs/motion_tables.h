#pragma once

#include <map>
#include <vector>

#include "embedded/gesture_numbers.h"
#include "fsm/base/table_folder.h"
#include "fsm/motion/base/face_look.h"
#include "fsm/motion/base/mixer.h"
#include "fsm/motion/base/unit_names.h"
#include "fsm/motion/inputs/emotion_space.h"
#include "fsm/motion/inputs/expression_table.h"
#include "fsm/motion/inputs/motion_patterns.h"
#include "fsm/motion/inputs/phoneme_names.h"
#include "fsm/motion/inputs/text_cues.h"
#include "fsm/motion/inputs/viseme_tables.h"

namespace fsm {

inline constexpr std::string_view kUnitNamesTable = "action_unit_names.txt";

/// The contents of all tables of motion. A plain value.
struct MotionTables {
  std::map<VisemeSetId, VisemeSet> sets;  ///< all of kVisemeSets
  std::vector<EngineNames> engines;
  DominanceReach reach;
  ExpressionTable expressions;
  EmotionSpace emotion_space;
  MotionPatterns motions;
  UnitList unit_list;
  UnitNames unit_names;
  BlendShapes blend_shapes;
  Mixer mixer;
  TextCues text_cues;
  MovementNumbers gestures;  ///< gestures.txt explains each number

  VisemeSet& set(VisemeSetId id) { return sets.at(id); }
  const VisemeSet& set(VisemeSetId id) const { return sets.at(id); }

  /// The names of their files.
  static std::vector<std::string_view> Files();
  /// Loads the tables: those in `folder`, and the built-in ones for the rest. Errors: kBadValue
  /// with file and line; kUnavailable if the folder or a file cannot be read.
  static vm::Result<MotionTables> Load(const TableFolder& folder = {});
};

}  // namespace fsm
