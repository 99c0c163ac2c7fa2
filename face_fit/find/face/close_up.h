#pragma once

#include "face_fit/find/network/found_face.h"

namespace facefit {

/// The part of a photo that a head made from a face in it shows: the face, its hair, neck and
/// shoulders.
struct CloseUp {
  fsm::Image image;
  FoundFace face;   ///< in pixels of `image`
  float scale = 1;  ///< pixels of `image` for each pixel of CloseUpOf's argument `photo`
};

/// Cuts a photo to about 33 cm on either side of a face's nose, 30 cm above it and 43 cm below,
/// scaled down to at most kWorkingSize on a side. Pixels come from `finest`, which is the same
/// photo with all its pixels, or `photo` itself. Returns `photo` unchanged, however fine `finest`
/// is, if more than 95 % of its width and of its height would be kept, or if the face lies outside.
CloseUp CloseUpOf(const fsm::Image& photo, const fsm::Image& finest, const FoundFace& face);

}  // namespace facefit
