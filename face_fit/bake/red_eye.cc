#include "face_fit/bake/red_eye.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

float RedShare(glm::vec3 c) { return c.r / std::max(0.5F * (c.g + c.b), 1.0F); }
float Blueness(glm::vec3 c) { return c.b / std::max(c.g, 1.0F); }
float Redder(glm::vec3 colour, glm::vec3 skin) {
  return RedShare(colour) / std::max(RedShare(skin), 0.1F);
}

}  // namespace

float RedEye(glm::vec3 colour, glm::vec3 skin) {
  const fsm::NumberTable& look = PhotoLook();
  const float bluer = Blueness(colour) / std::max(Blueness(skin), 0.1F);
  const float bright = colour.r / std::max(skin.r, 1.0F);
  return Ramp(look.Pair("flash_redder"), Redder(colour, skin)) *
         Ramp(look.Pair("flash_bluer"), bluer) * Ramp(look.Pair("flash_bright"), bright);
}

glm::vec3 WithoutRedEye(glm::vec3 colour, glm::vec3 skin, float near) {
  // A pupil is dark; what else shines in it is left a little brighter.
  const float part = near * glm::smoothstep(1.0F, 1.15F, Redder(colour, skin));
  return glm::mix(colour, glm::vec3(PhotoLook()("flash_pupil") * 0.5F * (colour.g + colour.b)),
                  part);
}

}  // namespace facefit
