#pragma once

#include "fsm/motion/inputs/lip_style.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// The timing of onsets of expressions: as measured on people for deliberate (kPosed) or
/// spontaneous (kElicited) expressions, or a fixed time.
enum class Onset { kPosed, kElicited, kFixed };

/// Durations of movements, which the original has in its configuration, and settings of speech.
struct MotionSettings {
  Onset onset = Onset::kPosed;
  vm::Time expression = std::chrono::milliseconds(100);  ///< EXPRESSION_DURATION; used by kFixed
  vm::Time eye_move = std::chrono::milliseconds(70);     ///< EYEMOVE_DURATION
  double lead_ms = 40;        ///< by which the mouth is ahead of the voice
  double offset_ms = 0;       ///< added delay of the mouth
  double sync_offset_ms = 0;  ///< added to the position that the voice reports
  double sync_rate = 0.25;    ///< how fast a difference is corrected, ms per ms
  /// The size of mouth movements in the original's unit: kFullMouthScale is the full articulation
  /// of the viseme table; the default 30 is three quarters of it, as in natural speech.
  double mouth_scale = 30;
  /// Distance of the point looked at; 0 = infinite, the eyes are parallel.
  double gaze_distance_mm = 700;
  LipStyle lips;
};
inline constexpr double kFullMouthScale = 40;

}  // namespace fsm
