#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fit.h"
#include "face_fit/fit/side_photo.h"

namespace facefit {

/// A photo of the person from the side, as the skin's map takes colours from it.
struct SideView {
  CameraPose pose;
  FigureCutout figure;
  /// A full profile: only its outline is used. Front and profile show too little of the same skin
  /// to bring both photos into one light.
  bool outline_only = false;
};

/// Corrects the depth of a fit by a photo of the person from the side, turned or in full profile.
/// `front_image`: the photo of the fit. Errors, with which the fit stays as it is: as FitSidePose.
vm::Result<SideView> CorrectDepthBy(FaceNetworks& networks, const fsm::Image& front_image,
                                    const SidePhoto& side_photo, Fit& fit);

}  // namespace facefit
