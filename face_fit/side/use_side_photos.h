#pragma once

#include <span>
#include <string>
#include <vector>

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fit.h"
#include "face_fit/side/side_photo.h"

namespace facefit {

class FaceNetworks;

/// A photo of the person from the side from which the skin's map takes colours.
struct PosedSidePhoto {
  FoundFace face;
  CameraPose pose;
  FigureCutout figure;
};

/// A photo from the side that could not be used.
struct RejectedPhoto {
  std::string path, reason;
};

/// A fit corrected by photos from the side, and what became of each of them.
struct SidePhotoFit {
  FaceFit fit;
  /// Of turned faces. There is none of a full profile: front and profile show too little common
  /// skin to match their light.
  std::vector<PosedSidePhoto> views;
  std::vector<RejectedPhoto> rejected;
};
/// Corrects the depth of a fit by photos of the person from the side, turned or in full profile.
/// `front_photo`: the photo of the fit. Throws std::runtime_error if rendering is impossible.
SidePhotoFit UseSidePhotos(FaceNetworks& networks, const fsm::Image& front_photo,
                           std::span<const SidePhoto* const> side_photos, FaceFit fit);

}  // namespace facefit
