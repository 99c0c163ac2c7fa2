#pragma once

#include <glm/vec2.hpp>

#include "face_fit/find/face/iris.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// Where an iris is expected in a photo; the scale is relative to the base head's eye.
struct IrisPlacement {
  glm::vec2 centre_px;
  float pixels_per_mm;
};
/// Returns where an eye with these lids has its iris if it looks into the camera and is formed as
/// the base head's.
IrisPlacement ExpectedIris(const ObservedHead& base, const EyePoints& lids, fsm::Side side);

/// Returns by how many pixels the lids lie off an iris, up or down across the eye, beyond what is
/// normal. The network misplaced them by that. 0 if the photo does not show the iris.
glm::vec2 LidShiftPx(const ObservedHead& base, const EyePoints& lids, const IrisCircle& iris,
                     fsm::Side side);

/// The irises in the photo.
struct PhotoIrises {
  fsm::Sided<IrisCircle> circles;
  float size = 1;  ///< iris radius relative to the built-in head's, after scaling by the eye's size
};
/// Irises that the photo does not show are assumed by the outlines of the eyes, with a contrast of
/// 0.
PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image& photo);

}  // namespace facefit
