#pragma once

#include <algorithm>
#include <concepts>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "fsm/base/smooth_step.h"

namespace fsm {

/// What a table's row "NAME FROM to TO" says: how something goes from one value to another, over
/// which places it fades in, or which values it may have. `from` may exceed `to`, except for the
/// functions that say otherwise, whose rows are written "NAME FROM up_to TO".
struct Range {
  float from = 0, to = 0;

  /// Interpolates; `share` is usually 0..1.
  float At(float share) const { return glm::mix(from, to, share); }
  /// Returns 0 on the side of `from`, 1 on that of `to`, and a smooth cubic between.
  float Ramp(float x) const { return SmoothStep(from, to, x); }
  /// REQUIRES, here and below: from <= to.
  float Clamp(float x) const { return std::clamp(x, from, to); }
  glm::vec3 Clamp(glm::vec3 v) const { return glm::clamp(v, from, to); }
  bool Contains(float x) const { return x >= from && x <= to; }

  bool operator==(const Range&) const = default;
};

/// Returns the range moved by `offset`.
inline Range operator+(float offset, Range range) {
  return {offset + range.from, offset + range.to};
}

/// What a table's row "NAME START plus ADDED" says: a value, and what is added to it per unit of
/// something, or at most if that is a share or random.
struct Linear {
  float start = 0, added = 0;

  template <std::floating_point T>
  T At(T x) const {
    return start + added * x;
  }
  bool operator==(const Linear&) const = default;
};

}  // namespace fsm
