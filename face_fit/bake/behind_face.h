#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Returns the figure's colours with the face removed and the gap inpainted from its surroundings;
/// they show beside the face when the head turns. `pose`: projects to pixels of the figure.
fsm::Image BehindFace(const FittedHead& fitted, const CameraPose& pose, const FigureCutout& figure);

}  // namespace facefit
