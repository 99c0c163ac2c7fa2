#pragma once

#include "face_fit/find/network/found_face.h"

namespace facefit {

class FaceNetworks;

/// A photo in which people stand upright, and the faces it shows.
struct UprightPhoto {
  fsm::Image image;
  int orientation = 1;           ///< EXIF orientation of the given photo: 1, 3, 6 or 8; 1 = upright
  std::vector<FoundFace> faces;  ///< as returned by FindFaces
};

/// Finds the faces of a photo and turns it until people stand upright, whatever its file says.
/// Turned copies are searched only if the faces of the photo as given are, on the mean, not seen
/// clearly and upright, so one upright face in a group does not stop the search.
UprightPhoto SetUpright(FaceNetworks& networks, fsm::Image photo);

}  // namespace facefit
