#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fsm/base/smooth_step.h"
#include "vm_protocol/core/scheduler.h"

/// Easing curves. All go from 0 at u = 0 to 1 at u = 1 and are constant outside; all begin and end
/// with zero speed, because nothing in a face starts or stops abruptly.
namespace fsm {

inline double Clamp01(double u) { return std::clamp(u, 0.0, 1.0); }

/// Returns 6u^5 - 15u^4 + 10u^3, the minimum-jerk curve, whose acceleration is zero at both ends as
/// well.
inline double SmootherStep(double u) {
  u = Clamp01(u);
  return u * u * u * (u * (6 * u - 15) + 10);
}

/// Returns the share of V1 in the original's interpolation between key shapes, M(t) = W (V0 - V1) +
/// (V0 + V1) / 2 with W = cos(pi u) / 2.
inline double CosineStep(double u) { return (1 - std::cos(std::numbers::pi * Clamp01(u))) / 2; }

using vm::InMs;

/// Rounds to the nearest microsecond.
inline vm::Time FromMs(double ms) { return vm::Time(std::llround(ms * 1000)); }

/// Returns the share of `duration` that has passed at `t` since `start`, clamped to 0..1; a
/// duration of zero is a step.
inline double Progress(vm::Time t, vm::Time start, vm::Time duration) {
  if (t >= start + duration) return 1;
  if (t <= start) return 0;
  return static_cast<double>((t - start).count()) / static_cast<double>(duration.count());
}

}  // namespace fsm
