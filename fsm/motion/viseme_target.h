#pragma once

#include <string>
#include <vector>

#include "fsm/motion/motion_tables.h"
#include "vm_protocol/core/phonemes.h"

namespace fsm {

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
  std::string engine = "AUTO";  ///< whose phoneme names are used, see PhonemeReader
  double jaw = 1;               ///< factor on the jaw's opening, 0 (mumbled) .. 3
  double lips = 1;              ///< factor on the lips' movements, 0..3
};

/// The viseme of one phoneme, or of one half of a diphthong, with its strength and time.
struct VisemeTarget {
  double start_ms = 0;
  double length_ms = 0;
  MouthPose target;    ///< strength and style applied
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

inline constexpr double kApproachMs = 92;      ///< the transition time of the original
inline constexpr double kSeenMs = 34;          ///< slightly more than a frame at 30 per second
inline constexpr double kPhrasePauseMs = 110;  ///< a pause at least this long ends a phrase

}  // namespace fsm
