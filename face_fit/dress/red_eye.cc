#include "face_fit/dress/red_eye.h"

#include <algorithm>
#include <glm/common.hpp>

namespace facefit {

namespace {

float Redness(glm::vec3 c) { return c.r / std::max(0.5F * (c.g + c.b), 1.0F); }
float Blueness(glm::vec3 c) { return c.b / std::max(c.g, 1.0F); }
float Redder(glm::vec3 colour, glm::vec3 skin) {
  return Redness(colour) / std::max(Redness(skin), 0.1F);
}

}  // namespace

float RedEye(glm::vec3 colour, glm::vec3 skin) {
  const float bluer = Blueness(colour) / std::max(Blueness(skin), 0.1F);
  const float bright = colour.r / std::max(skin.r, 1.0F);
  return glm::smoothstep(1.15F, 1.4F, Redder(colour, skin)) * glm::smoothstep(0.75F, 0.95F, bluer) *
         glm::smoothstep(0.4F, 0.6F, bright);
}

glm::vec3 WithoutRedEye(glm::vec3 colour, glm::vec3 skin, float near) {
  // A pupil is dark; what else shines in it is left a little brighter.
  constexpr float kDark = 0.45F;
  const float part = near * glm::smoothstep(1.0F, 1.15F, Redder(colour, skin));
  return glm::mix(colour, glm::vec3(kDark * 0.5F * (colour.g + colour.b)), part);
}

}  // namespace facefit
