#pragma once

#include "face_fit/fit/fit.h"

namespace facefit {

struct FitByStereo {
  Fit fit;
  CameraPose side_pose;
};
/// Corrects the depth of a fit's constraints until patches of skin that both photos show coincide
/// in space, and refines `side_pose`, how the photo from the side was taken. Leaves depth unchanged
/// if too few patches are found in both.
FitByStereo CorrectDepthByStereo(const fsm::Image& front_image, const fsm::Image& side_image,
                                 CameraPose side_pose, Fit fit);

}  // namespace facefit
