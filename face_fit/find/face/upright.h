#pragma once

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// The EXIF orientation that sets the people in a photo upright, whatever its file says: 1 = as it
/// is, 3, 6 or 8. Turned copies are looked at only if nobody is seen clearly and upright as it is.
int UprightOrientation(FaceNetworks& networks, const fsm::Image& photo);

}  // namespace facefit
