#pragma once

#include <optional>

#include "face_fit/fit/fit.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// Finds the line of brow, nose, lips and chin of the fitted head on the outline of a figure
/// (`opacity`: 1 = figure), corrects the depth of the fit's constraints near the middle of the face
/// until both lines agree, and warps the head again. The residual is that before it was used.
/// Nothing if there is no outline like it; then the fit is as it was.
std::optional<PoseFit> RefineDepthByProfile(const FloatImage& opacity, Fit& fit);

}  // namespace facefit
