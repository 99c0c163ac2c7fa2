#pragma once

#include <chrono>

#include "vm_protocol/core/scheduler.h"

namespace fsm {

// Times and sizes that several parts of speech have in common. They are ours but for the first.

inline constexpr double kTransitionMs = 92;    ///< from key viseme to key viseme, in the original
inline constexpr double kMinClosureMs = 34;    ///< slightly more than a frame at 30 per second
inline constexpr double kPhrasePauseMs = 110;  ///< a pause at least this long ends a phrase

inline constexpr vm::Time kMouthFadeIn = std::chrono::milliseconds(60);  ///< speech takes the mouth
inline constexpr vm::Time kMouthCloses = std::chrono::milliseconds(110);  ///< after a stop
inline constexpr vm::Time kMouthFadeOut = std::chrono::milliseconds(300);
inline constexpr vm::Time kHeadReturns = std::chrono::milliseconds(700);  ///< after the end
/// The duration of a change of MotionSettings::mouth_scale.
inline constexpr vm::Time kMouthScaleMove = std::chrono::milliseconds(100);

/// Strengths of units 1 and 2 where the brows are raised in full.
inline constexpr double kInnerBrowRaise = 1, kOuterBrowRaise = 0.8;

}  // namespace fsm
