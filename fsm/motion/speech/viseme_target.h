#pragma once

#include <string>
#include <vector>

#include "fsm/motion/inputs/lip_style.h"
#include "fsm/motion/inputs/viseme_tables.h"
#include "vm_protocol/core/phonemes.h"

namespace fsm {

struct MotionTables;

/// The viseme of one phoneme, or of one half of a diphthong, with its strength and time.
struct VisemeTarget {
  double start_ms = 0;
  double length_ms = 0;
  MouthPose pose;      ///< strength and style applied
  double hold_ms = 0;  ///< how long a key viseme is held
  Dominance dominance;
  bool pause = false;
};

/// The viseme targets of an utterance.
struct VisemeTargets {
  std::vector<VisemeTarget> targets;  ///< in order of time, none of length 0
  MouthPose rest;
  Dominance rest_dominance;
  double length_ms = 0;
  /// Phonemes that no table has, once each; the lips close on them.
  std::vector<std::string> unknown;
};
VisemeTargets MakeVisemeTargets(const vm::PhonemeList& phonemes, const MotionTables& tables,
                                const LipStyle& style);

}  // namespace fsm
