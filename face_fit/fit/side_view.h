#pragma once

#include <optional>

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fit.h"
#include "face_fit/fit/side_photo.h"

namespace facefit {

/// A photo of the person from the side from which the skin's map takes colours.
struct SideView {
  const SidePhoto* photo = nullptr;  ///< outlives this
  CameraPose pose;
  FigureCutout figure;
};

/// Corrects the depth of a fit by a photo of the person from the side, turned or in full profile.
/// Returns the view, or nothing for a full profile, whose colours are not used: front and profile
/// show too little common skin to match their light. `front_image`: the photo of the fit;
/// `side_photo` outlives the view. Errors, after which the fit is unchanged: as FitSidePose.
vm::Result<std::optional<SideView>> CorrectDepthBy(FaceNetworks& networks,
                                                   const fsm::Image& front_image,
                                                   const SidePhoto& side_photo, Fit& fit);

}  // namespace facefit
