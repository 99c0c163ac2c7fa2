#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <string>
#include <string_view>

#include "embedded/photo_look_numbers.h"
#include "fsm/base/number_table.h"

namespace facefit {

/// What a face made from a photo looks like: tables/photo_look.txt, where each number is explained.
/// Read once; constant, thread: any.
const PhotoLookNumbers& PhotoLook();
/// The same with the rows of `text` in place of the built-in ones; `name` is for messages. Throws
/// as fsm::NumberTable.
PhotoLookNumbers PhotoLookOf(const std::string& name, std::string_view text);

/// From 0 at the first number of a range to 1 at the second, smoothly; the first may be the larger.
inline float Ramp(glm::vec2 range, float v) { return glm::smoothstep(range.x, range.y, v); }

}  // namespace facefit
