#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "fsm/motion/base/easing.h"
#include "fsm/rig/angles.h"

namespace fsm {

/// Eyes that jump from place to place. The jump to place k begins at `start_ms(k)`, between k - 1
/// and k + 1 intervals, and lasts `jump_ms(from, to)`; `place(k)` is in degrees down and to the
/// viewer's right.
template <typename Start, typename Place, typename Jump>
EyeAngles FixationAt(double ms, double interval_ms, const Start& start_ms, const Place& place,
                     const Jump& jump_ms) {
  auto k = static_cast<std::int64_t>(std::floor(ms / interval_ms));
  if (ms < start_ms(k)) --k;
  if (ms >= start_ms(k + 1)) ++k;
  const std::array<double, 2> from = place(k - 1), to = place(k);
  const double u = SmootherStep((ms - start_ms(k)) / jump_ms(from, to));
  return {static_cast<float>(from[kDown] + u * (to[kDown] - from[kDown])),
          static_cast<float>(from[kToRight] + u * (to[kToRight] - from[kToRight]))};
}

}  // namespace fsm
