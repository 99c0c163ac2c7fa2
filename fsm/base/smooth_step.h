#pragma once

#include <algorithm>

namespace fsm {

/// 0 below `from`, 1 above `to`, smooth between; `from` may exceed `to`.
inline float SmoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace fsm
