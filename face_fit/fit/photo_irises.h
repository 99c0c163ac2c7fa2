#pragma once

#include <glm/vec2.hpp>

#include "face_fit/find/face/iris.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/found_face.h"

namespace facefit {

/// An iris in a photo.
struct PhotoIris {
  IrisCircle circle;  ///< as expected, with a contrast of 0, if the photo does not show it
  ExpectedEye expected = {};
  bool seen = false;  ///< with a contrast of kClearIris or more
};
/// Returns by how many pixels the lids lie off an iris, up or down across the eye, beyond what is
/// normal. The network misplaced them by that. 0 if the photo does not show the iris.
glm::vec2 LidShiftPx(const PhotoIris& iris);

struct PhotoIrises {
  fsm::Sided<PhotoIris> eyes;
  float size = 1;  ///< iris radius relative to the built-in head's, after scaling by the eye's size
};
PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image& photo);

}  // namespace facefit
