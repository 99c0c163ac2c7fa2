#pragma once

#include <glm/vec3.hpp>

#include "face_fit/find/network/found_face.h"
#include "face_fit/fit/photo_irises.h"

namespace facefit {

/// Colours of the eyes as they are drawn, linear RGB: from the photo, the iris brighter, the white
/// paler (rows `iris`, `white` of tables/photo_look.txt).
struct EyeColours {
  glm::vec3 iris, white;
};
EyeColours SampleEyes(const FoundFace& face, const PhotoIrises& irises, const fsm::Image& photo);

/// PhotoHead::lip_colour (linear RGB) and PhotoHead::teeth.
struct MouthColours {
  glm::vec3 lip;
  float teeth;
};
MouthColours SampleMouth(const FoundFace& face, const fsm::Image& photo);

}  // namespace facefit
