#pragma once

#include <expected>
#include <string>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/side/side_photo.h"

namespace facefit {

class FaceNetworks;

/// Why a photo from the side gives no pose.
struct NoSidePose {
  bool may_be_profile;  ///< there is nothing to compare, as in full profile
  std::string reason;   ///< a sentence
};
/// Finds the pose of the fitted head in a photo of the person from the side. The network's error is
/// measured on the head drawn in that pose and subtracted from its points in the photo. It may be a
/// profile if the photo has no face, an uncertain one, misplaced points, or one turned too far; not
/// if the face is seen from the front again, or another person's. Throws std::runtime_error if
/// rendering is impossible.
std::expected<CameraPose, NoSidePose> FitSidePose(FaceNetworks& networks, const FittedHead& fitted,
                                                  const SidePhoto& side_photo);

}  // namespace facefit
