#pragma once

#include <glm/vec2.hpp>

#include "face_fit/find/face/iris.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// The outline of an eye: its corners and the middle between the lids. Pixels.
struct LidSpan {
  glm::vec2 outer, inner, middle;
};
/// `pixel_of(point)`: the pixel of a point of the network.
template <typename PixelOf>
LidSpan LidSpanOf(fsm::Side side, PixelOf pixel_of) {
  const auto outline = point::kEyeOutline[side];
  return {pixel_of(outline[kOuterCorner]), pixel_of(outline[kInnerCorner]),
          0.5F * (pixel_of(outline[kUpperMiddle]) + pixel_of(outline[kLowerMiddle]))};
}

/// Where an iris is expected in a photo; the scale is relative to the base head's eye.
struct IrisPlacement {
  glm::vec2 centre;
  float pixels_per_mm;
};
/// Returns where an eye with these lids has its iris if it looks into the camera and is formed as
/// the base head's.
IrisPlacement ExpectedIris(const ObservedHead& base, const LidSpan& lids, fsm::Side side);

/// Returns by how many pixels the lids lie off an iris, up or down across the eye, beyond what is
/// normal. The network misplaced them by that. 0 if the photo does not show the iris.
glm::vec2 LidShiftPx(const ObservedHead& base, const LidSpan& lids, const IrisCircle& iris,
                     fsm::Side side);

/// The irises in the photo.
struct PhotoIrises {
  fsm::Sided<IrisCircle> circles;
  float size = 1;  ///< iris radius relative to the built-in head's, after scaling by the eye's size
};
/// Without a photo irises are assumed by the outlines of the eyes, with a contrast of 0.
PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image* photo);

}  // namespace facefit
