#pragma once

#include <optional>
#include <string>

#include "face_fit/find/network/found_face.h"
#include "vm_protocol/core/result.h"

namespace facefit {

class FaceNetworks;

/// The most photos from the side that are used for one face.
inline constexpr std::size_t kMaxSidePhotos = 6;
/// Error: kLimit, there are more.
vm::Result<void> CheckSidePhotoCount(std::size_t count);

/// Another photo of the person, from the side, upright, and the largest face found in it.
struct SidePhoto {
  std::string path;
  fsm::Image image;
  std::optional<FoundFace> face;
};
/// Reads a photo, turns it upright by what it shows, and finds its face. Errors: as ReadPhoto.
vm::Result<SidePhoto> ReadSidePhoto(FaceNetworks& networks, const std::string& path);

}  // namespace facefit
