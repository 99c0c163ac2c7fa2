#include "face_fit/bake/red_eye.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Redness relative to the skin's at which a colour begins to be replaced, and from which it is
/// replaced wholly.
constexpr fsm::Range kRedderThanSkin{1, 1.15F};

float RedShare(glm::vec3 c) { return c.r / std::max(0.5F * (c.g + c.b), 1.0F); }
float Blueness(glm::vec3 c) { return c.b / std::max(c.g, 1.0F); }
float Redder(glm::vec3 colour, glm::vec3 skin_colour) {
  return RedShare(colour) / std::max(RedShare(skin_colour), 0.1F);
}

}  // namespace

float RedEye::Likelihood(glm::vec3 colour) const {
  const float bluer = Blueness(colour) / std::max(Blueness(skin_colour_), 0.1F);
  const float bright = colour.r / std::max(skin_colour_.r, 1.0F);
  const auto& flash = PhotoLook().flash;
  return flash.redder.Ramp(Redder(colour, skin_colour_)) * flash.bluer.Ramp(bluer) *
         flash.bright.Ramp(bright);
}

glm::vec3 RedEye::Without(glm::vec3 colour, float near) const {
  // A pupil is dark; other highlights in it stay slightly brighter.
  const float share = near * kRedderThanSkin.Ramp(Redder(colour, skin_colour_));
  return glm::mix(colour, glm::vec3(PhotoLook().flash.pupil_share * 0.5F * (colour.g + colour.b)),
                  share);
}

}  // namespace facefit
