#include "face_fit/side/side_photo.h"

#include <utility>

#include "face_fit/find/face/upright.h"
#include "face_fit/image/photo.h"

namespace facefit {

vm::Result<void> CheckSidePhotoCount(std::size_t count) {
  if (count <= kMaxSidePhotos) return {};
  return vm::Fail(vm::Errc::kLimit,
                  "at most " + std::to_string(kMaxSidePhotos) + " photos from the side are used");
}

vm::Result<SidePhoto> ReadSidePhoto(FaceNetworks& networks, const std::string& path) {
  auto photo = ReadPhoto(path);
  if (!photo) return std::unexpected(photo.error());
  UprightPhoto upright = SetUpright(networks, std::move(*photo));
  SidePhoto side_photo{path, std::move(upright.image), {}};
  if (!upright.faces.empty()) side_photo.face = std::move(upright.faces.front());
  return side_photo;
}

}  // namespace facefit
