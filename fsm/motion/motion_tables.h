#pragma once

#include <string>
#include <vector>

#include "embedded/gesture_numbers.h"
#include "fsm/base/table_folder.h"
#include "fsm/motion/action_units.h"
#include "fsm/motion/emotion_space.h"
#include "fsm/motion/emotion_table.h"
#include "fsm/motion/mixer.h"
#include "fsm/motion/motion_patterns.h"
#include "fsm/motion/phoneme_names.h"
#include "fsm/motion/text_cues.h"
#include "fsm/motion/unit_names.h"
#include "fsm/motion/viseme_tables.h"

namespace fsm {

/// Everything that is known about moving, read from the tables. A plain value.
struct MotionTables {
  VisemeSet set14, set28;
  std::vector<EngineNames> engines;
  Reach reach;
  EmotionTable emotions;
  EmotionSpace emotion_space;
  MotionPatterns motions;
  UnitList units;
  UnitNames unit_names;
  BlendShapes blend_shapes;
  Mixer mixer;
  TextCues text_cues;
  GestureNumbers gestures;  ///< gestures.txt, where each number is explained

  VisemeSet& set(VisemeSetId id) { return id == VisemeSetId::k14 ? set14 : set28; }
  const VisemeSet& set(VisemeSetId id) const { return id == VisemeSetId::k14 ? set14 : set28; }

  /// The tables the program carries, but for those that the folder replaces. Errors: kBadValue with
  /// file and line; kUnavailable if the folder or a file cannot be read.
  static vm::Result<MotionTables> Load(const TableFolder& folder = {});
};

}  // namespace fsm
