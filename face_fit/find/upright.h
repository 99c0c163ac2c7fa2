#pragma once

#include "face_fit/find/face_finder.h"

namespace facefit {

/// How a photo has to be turned so that the person stands upright, whatever the file says of it:
/// an EXIF orientation, 1 = as it is, 3, 6 or 8. Other ways are only tried if nobody is seen
/// clearly and upright as it is.
int UprightWay(FaceNetworks& networks, const fsm::Image& photo);

}  // namespace facefit
