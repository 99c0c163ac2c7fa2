#pragma once

#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Measures depth by finding small patches of skin of the first photo in the one from the side: of
/// a turned face the network mostly tells what faces are like in general, patches tell how far this
/// one stands forward. `side_pose`: how `side_image` was taken, which is refined. Returns places of
/// the base head at rest, and by how many millimetres each lies nearer to the first photo's camera
/// than the fit has it; none if fewer than 25 patches are found.
std::vector<fsm::WarpPoint> CompareDepth(const FittedHead& fitted, const fsm::Image& front_image,
                                         const fsm::Image& side_image, CameraPose& side_pose);

}  // namespace facefit
