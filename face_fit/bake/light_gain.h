#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "face_fit/tables/photo_look.h"

namespace facefit {

/// What a colour is multiplied by, channel by channel, to stand in another light: that of `to`,
/// where `from` is of its own. Within light_gain of the table.
inline glm::vec3 LightGain(glm::vec3 to, glm::vec3 from) {
  const glm::vec2 limit = PhotoLook().light_gain;
  return glm::clamp(to / from, limit.x, limit.y);
}

}  // namespace facefit
