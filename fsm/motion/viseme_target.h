#pragma once

#include <string>
#include <vector>

#include "fsm/motion/motion_tables.h"
#include "vm_protocol/core/phonemes.h"

namespace fsm {

/// How lips go from sound to sound.
enum class LipMode {
  kDominance,  ///< overlapping dominance curves with anticipation
  kSinusoid,   ///< the original's: key visemes joined by half a cosine
  kLinear,     ///< key visemes joined by straight lines, for comparison
};

/// How an utterance is to be articulated; taken when it begins.
struct LipStyle {
  LipMode mode = LipMode::kDominance;
  VisemeSetId visemes = VisemeSetId::k28;
  Language language = Language::kAuto;
  std::string engine = "AUTO";  ///< whose phoneme names, see PhonemeReader
  double jaw = 1;               ///< size of the jaw's opening, 0 (mumbled) .. 3
  double lips = 1;              ///< size of the lips' movements, the same
};

/// A viseme with its strength, in time: what one phoneme, or one half of a diphthong, asks.
struct VisemeTarget {
  double start_ms = 0;
  double length_ms = 0;
  MouthPose target;    ///< strength and style applied
  double hold_ms = 0;  ///< how long a key viseme stands
  Dominance dominance;
  bool pause = false;
};

/// What a sentence asks of the mouth.
struct VisemeTargets {
  std::vector<VisemeTarget> targets;  ///< in time, without those of no length
  MouthPose rest;
  Dominance rest_dominance;
  double length_ms = 0;
  std::vector<std::string> unknown;  ///< phonemes no table has, once each: lips close on them
};
VisemeTargets MakeVisemeTargets(const vm::PhonemeList& phonemes, const MotionTables& tables,
                                const LipStyle& style);

inline constexpr double kApproachMs = 92;      ///< the original's time of transition
inline constexpr double kSeenMs = 34;          ///< just over one frame at 30 a second
inline constexpr double kPhrasePauseMs = 110;  ///< a pause from here on ends a phrase

}  // namespace fsm
