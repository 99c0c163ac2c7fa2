#pragma once

#include "face_fit/fit/fit.h"

namespace facefit {

/// Corrects the depth of a fit's constraints until skin that two photos show lies at one place in
/// space, and refines `side_pose`, that of the photo from the side. Depth stays as it is where too
/// little skin is found in both.
void CorrectDepthByStereo(const fsm::Image& front_image, const fsm::Image& side_image,
                          CameraPose& side_pose, Fit& fit);

}  // namespace facefit
