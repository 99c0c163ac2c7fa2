#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "fsm/base/number_table.h"

namespace facefit {

/// What a face made from a photo looks like: tables/appearance.txt, where each number is explained.
/// Read once; constant, thread: any.
const fsm::NumberTable& PhotoLook();

/// From 0 at the first number of a range to 1 at the second, smoothly; the first may be the larger.
inline float Ramp(glm::vec2 range, float v) { return glm::smoothstep(range.x, range.y, v); }

}  // namespace facefit
