#pragma once

#include "face_fit/fit/fit.h"

namespace facefit {

/// Corrects the depth of a fit's constraints until patches of skin that both photos show coincide
/// in space, and refines `side_pose`, the pose of the photo from the side. Leaves depth unchanged
/// if too few patches are found in both.
void CorrectDepthByStereo(const fsm::Image& front_image, const fsm::Image& side_image,
                          CameraPose& side_pose, Fit& fit);

}  // namespace facefit
