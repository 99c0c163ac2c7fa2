#pragma once

#include "face_fit/fit/fitted_head.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/fit/side_photo.h"

namespace facefit {

/// Finds the pose of the fitted head in a photo of the person from the side. The network's error is
/// measured on the head drawn in that pose and subtracted from its points in the photo. Errors,
/// with a sentence: kUnavailable, there is nothing to compare, as in full profile (no face, an
/// uncertain one, misplaced points, or one turned too far); kBadValue, the face does not help (seen
/// from the front again, or another person's). Throws std::runtime_error if rendering is
/// impossible.
vm::Result<CameraPose> FitSidePose(FaceNetworks& networks, const FittedHead& fitted,
                                   const SidePhoto& side_photo);

}  // namespace facefit
