#pragma once

#include "fsm/motion/viseme_target.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// How expressions come about: as measured on people, shown or felt, or in a fixed time.
enum class Onset { kPosed, kElicited, kFixed };

/// Times of movements which the original keeps in its configuration, and settings of speech.
struct MotionSettings {
  Onset onset = Onset::kPosed;
  vm::Time expression = std::chrono::milliseconds(100);  ///< EXPRESSION_DURATION, of kFixed
  vm::Time eye_move = std::chrono::milliseconds(70);     ///< EYEMOVE_DURATION
  double lead_ms = 40;                                   ///< the mouth is ahead of the voice
  double offset_ms = 0;                                  ///< delays the mouth
  double sync_offset_ms = 0;                             ///< added to what the voice reports
  double sync_rate = 0.25;  ///< how fast a difference is worked off, ms a ms
  /// The original's unit for the size of mouth movements; kFullMouthScale gives the full
  /// articulation of the shape table, the default 30 the three quarters of natural speech.
  double mouth_scale = 30;
  double gaze_distance_mm = 700;  ///< of what the eyes look at; 0 = far, the eyes are parallel
  LipStyle lips;
};
inline constexpr double kFullMouthScale = 40;

}  // namespace fsm
