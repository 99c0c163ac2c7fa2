#pragma once

#include <glm/vec3.hpp>

#include "face_fit/tables/photo_look.h"

namespace facefit {

/// Returns the gain of each channel that moves a colour from one light to another: the ratio of
/// `to` to `from`, colours of similar skin in either light, clamped to light_gain of the table.
inline glm::vec3 LightGain(glm::vec3 to, glm::vec3 from) {
  return PhotoLook().light_gain.Clamp(to / from);
}

}  // namespace facefit
