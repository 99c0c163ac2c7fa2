#pragma once

#include <optional>

#include "face_fit/fit/fit.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// Finds the line of brow, nose, lips and chin of the fitted head on the outline of a figure
/// (`opacity`: 1 = figure), and corrects the depth of the fit's constraints near the middle of the
/// face until both lines agree. Returns how the figure's photo was taken; nothing, and `fit` stays
/// as it is, if the figure has no outline like it.
std::optional<CameraPose> CorrectDepthByProfile(const FloatImage& opacity, Fit& fit);

}  // namespace facefit
