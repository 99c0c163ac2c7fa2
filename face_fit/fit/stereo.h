#pragma once

#include <vector>

#include "face_fit/find/head/base_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Measures depth by finding small patches of skin of the first photo in the second: of a turned
/// face the network mostly tells what faces are like in general, patches tell how far this one
/// stands forward. Refines `pose`, that of the second photo. Returns places of the base head at
/// rest and by how many millimetres each lies nearer to the first photo's camera than the fit has
/// it; empty if fewer than 25 patches are found.
std::vector<fsm::WarpPoint> CompareDepth(const FittedHead& fitted, const fsm::Image& front,
                                         const fsm::Image& extra, CameraPose& pose);

}  // namespace facefit
