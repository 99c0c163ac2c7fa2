#pragma once

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// The part of a photo that a head made from one of its faces shows: the face, its hair, neck
/// and shoulders.
struct CloseUp {
  fsm::Image photo;
  FoundFace face;   ///< in pixels of that part
  float scale = 1;  ///< its pixels by one of the photo as it was worked on
};

/// Cuts a photo to some 33 centimetres to either side of a face, 30 above its nose and 43 below, at
/// most kWorkingSize on a side. Of a group or a whole figure little else is left, and what is left
/// is as fine as the photo has it.
/// `finest`: the same photo with all its pixels, or `photo` itself. Where nothing would be cut off
/// and nothing gained it is `photo` as it is.
CloseUp CloseUpOf(const fsm::Image& photo, const fsm::Image& finest, const FoundFace& face);

}  // namespace facefit
