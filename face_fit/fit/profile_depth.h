#pragma once

#include <optional>

#include "face_fit/fit/fit.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// Finds the profile of the fitted head (brow, nose, lips, chin) on the outline of a figure
/// (`opacity`: 1 = figure), and corrects the depth of the fit's constraints near the middle of the
/// face until the two agree. Returns how the figure's photo was taken. Returns nothing, and leaves
/// `fit` unchanged, if nothing of the outline resembles the profile.
std::optional<CameraPose> CorrectDepthByProfile(const Mask& opacity, Fit& fit);

}  // namespace facefit
