#pragma once

#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Where skin of the fitted head lies by two photos of it.
struct StereoDepths {
  CameraPose side_pose;  ///< of the photo from the side, refined
  /// Places of the base head at rest, and by how many millimetres each lies nearer to the first
  /// photo's camera than the fit has it; empty if fewer than 25 patches are found.
  std::vector<fsm::WarpPoint> depths;
};
/// Measures depth by finding small patches of skin of the first photo in the one from the side: of
/// a turned face the network mostly tells what faces are like in general, patches tell how far this
/// one stands forward. `side_pose`: that of `side` so far.
StereoDepths CompareDepth(const FittedHead& fitted, const fsm::Image& front, const fsm::Image& side,
                          const CameraPose& side_pose);

}  // namespace facefit
