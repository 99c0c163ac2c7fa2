#pragma once

#include "face_fit/fit/fitted_head.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/fit/side_photo.h"

namespace facefit {

/// Finds the pose of the fitted head in a photo of the person from the side. The head is drawn in
/// that pose and shown to the same network: what the network gets wrong of the drawn head is
/// subtracted from what it says of the photo. Errors (kBadValue, in words): no face; from the front
/// again; turned too far; not this face.
vm::Result<CameraPose> FitSidePose(FaceNetworks& networks, const FittedHead& fitted,
                                   const SidePhoto& side_photo);

}  // namespace facefit
