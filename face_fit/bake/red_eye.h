#pragma once

#include <glm/vec3.hpp>

namespace facefit {

/// The probability, 0..1, that a colour in an iris is a flash reflected by the back of the eye:
/// much redder than the skin, about as bright, and with as much blue relative to green. Brown
/// irises have less blue or are darker. Both colours 0..255; `skin`: below the eye.
float RedEye(glm::vec3 colour, glm::vec3 skin);

/// The colour with the red of a flash replaced by dark grey. `near`: the highest RedEye of the
/// pixel and those close to it, because in a photo red runs over the edge of the pupil.
glm::vec3 WithoutRedEye(glm::vec3 colour, glm::vec3 skin, float near);

}  // namespace facefit
