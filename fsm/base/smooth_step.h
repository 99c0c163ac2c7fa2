#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <type_traits>

namespace fsm {

/// Returns 0 below `from`, 1 above `to`, and a smooth cubic between; `from` may exceed `to`.
template <std::floating_point T>
T SmoothStep(std::type_identity_t<T> from, std::type_identity_t<T> to, T x) {
  const T t = std::clamp<T>((x - from) / (to - from), 0, 1);
  return t * t * (3 - 2 * t);
}
inline double SmoothStep(double u) { return SmoothStep(0, 1, u); }

/// Returns the Gaussian weight at a distance of `squared` squared standard deviations.
inline float Gaussian(float squared) { return std::exp(-0.5f * squared); }

/// About exp(-(x / width)^2), cut to 0 from two widths on. A width of 0 or less gives 0.
inline float Bell(float x, float width) {
  if (!(std::abs(x) < 2 * width)) return 0;
  const float t = std::max(1 - x * x / (4 * width * width), 0.0f);
  return t * t * t * t;
}

}  // namespace fsm
