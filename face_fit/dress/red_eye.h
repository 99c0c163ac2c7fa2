#pragma once

#include <glm/vec3.hpp>

namespace facefit {

/// How surely a colour seen in an iris is the red that a flash throws back from behind the pupil,
/// 0..1: much redder than the skin, about as bright, and with as much blue to green as that. Brown
/// irises have less blue, or are darker. Both 0..255; `skin`: below the eye.
float RedEye(glm::vec3 colour, glm::vec3 skin);

/// The colour without that red, dark and grey; `near`: the most that RedEye says of it and of what
/// lies close to it, for in a photo red runs over the pupil's edge.
glm::vec3 WithoutRedEye(glm::vec3 colour, glm::vec3 skin, float near);

}  // namespace facefit
