#pragma once

#include "face_fit/fit/fitted_head.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/fit/side_photo.h"

namespace facefit {

/// Finds the pose of the fitted head in a photo of the person from the side. The network's error is
/// measured on the head drawn in that pose and subtracted from its points in the photo. Errors
/// (kBadValue, with a sentence): no face; seen from the front again; turned too far; another
/// person's face.
vm::Result<CameraPose> FitSidePose(FaceNetworks& networks, const FittedHead& fitted,
                                   const SidePhoto& side_photo);

}  // namespace facefit
