#pragma once

#include <optional>
#include <vector>

#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Refines `side_pose`, how `side_photo` was taken, until the patches of skin of the front photo
/// that are found in it lie where the fitted head has them. Returns nothing if fewer than 25 are
/// found.
std::optional<CameraPose> RefineSidePose(const FittedHead& fitted, const fsm::Image& front_photo,
                                         const fsm::Image& side_photo, CameraPose side_pose);

/// Measures depth by finding small patches of skin of the front photo in a photo from the side: of
/// a turned face the network mostly reports what faces have in common. `side_pose`: as refined by
/// RefineSidePose. Returns positions on the base head at rest, and by how many millimetres each
/// lies nearer to the front photo's camera than in the fit; empty if fewer than 25 patches are
/// found.
std::vector<fsm::WarpPoint> MeasureDepth(const FittedHead& fitted, const fsm::Image& front_photo,
                                         const fsm::Image& side_photo, const CameraPose& side_pose);

}  // namespace facefit
