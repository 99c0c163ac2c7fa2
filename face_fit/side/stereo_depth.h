#pragma once

#include "face_fit/fit/fit.h"

namespace facefit {

/// A fit corrected by a photo from the side, and how that photo was taken.
struct StereoFit {
  FaceFit fit;
  CameraPose side_pose;
};
/// Corrects the depth of a fit's constraints until patches of skin that both photos show coincide
/// in space, and refines `side_pose`, how the photo from the side was taken. Leaves depth unchanged
/// if too few patches are found in both.
StereoFit CorrectDepthByStereo(const fsm::Image& front_photo, const fsm::Image& side_photo,
                               CameraPose side_pose, FaceFit fit);

}  // namespace facefit
