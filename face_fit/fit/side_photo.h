#pragma once

#include <string>
#include <vector>

#include "face_fit/find/network/face_finder.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// The most photos from the side that are used for one face.
inline constexpr std::size_t kMaxSidePhotos = 6;
/// Error: kLimit, there are more.
vm::Result<void> CheckSidePhotoCount(std::size_t count);

/// Another photo of the person, from the side, upright, and the faces found in it.
struct SidePhoto {
  std::string path;
  fsm::Image photo;
  std::vector<FoundFace> faces;
};
/// Reads a photo, turns it upright by what it shows, and finds its faces. Errors: as ReadPhoto.
vm::Result<SidePhoto> ReadSidePhoto(FaceNetworks& networks, const std::string& path);

}  // namespace facefit
