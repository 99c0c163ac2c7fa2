#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fit.h"
#include "face_fit/fit/side_photo.h"

namespace facefit {

/// A photo of the person from the side from which the skin's map takes colours.
struct SideView {
  CameraPose pose;
  FigureCutout figure;
  /// The photo is a full profile, which only corrects depth: the other members are not used. Front
  /// and profile show too little common skin to match their light.
  bool outline_only = false;
};

/// Corrects the depth of a fit by a photo of the person from the side, turned or in full profile.
/// `front_image`: the photo of the fit. Errors, after which the fit is unchanged: as FitSidePose.
vm::Result<SideView> CorrectDepthBy(FaceNetworks& networks, const fsm::Image& front_image,
                                    const SidePhoto& side_photo, Fit& fit);

}  // namespace facefit
