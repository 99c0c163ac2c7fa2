#pragma once

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// A photo in which people stand upright, and the faces it shows.
struct UprightPhoto {
  fsm::Image photo;
  int orientation = 1;  ///< EXIF's of the photo as it was: 1, 3, 6 or 8; 1 = it stood upright
  std::vector<FoundFace> faces;  ///< as of FindFaces
};

/// Finds the faces of a photo and turns it until the people in it stand upright, whatever its file
/// says. Turned copies are looked at only if nobody is seen clearly and upright as it is.
UprightPhoto SetUpright(FaceNetworks& networks, fsm::Image photo);

}  // namespace facefit
