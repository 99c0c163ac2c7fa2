#pragma once

#include <glm/vec2.hpp>

#include "face_fit/find/face_finder.h"

namespace facefit {

/// The edge between an iris and the white, as seen in a photo.
struct IrisRing {
  glm::vec2 centre;
  float radius = 0;    ///< pixels
  float contrast = 0;  ///< how much brighter the white is, 0..1; below kClearRing nothing was seen
};
inline constexpr float kClearRing = 0.06F;

/// Looks between two corners of an eye for the circle whose sides to the right and left are darkest
/// within and brightest without; lids hide the rest of it. `expected`: its radius by the head's
/// form, pixels.
IrisRing FindIris(const fsm::Image& photo, glm::vec2 corner, glm::vec2 other_corner,
                  glm::vec2 middle, float expected);

}  // namespace facefit
