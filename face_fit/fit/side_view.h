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

/// A fit whose depth a photo from the side has corrected, and that photo.
struct SideCorrection {
  Fit fit;
  SideView view;
};
/// Corrects the depth of a fit by a photo of the person from the side. `front`: the photo of the
/// fit. Errors: as FitSidePose.
vm::Result<SideCorrection> CorrectDepthBy(FaceNetworks& networks, const fsm::Image& front,
                                          const SidePhoto& side, const Fit& fit);

}  // namespace facefit
