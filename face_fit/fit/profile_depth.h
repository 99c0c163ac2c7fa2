#pragma once

#include <optional>

#include "face_fit/fit/fit.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// Finds the line of brow, nose, lips and chin of the fitted head on the outline of a figure
/// (`opacity`: 1 = figure), and corrects the depth of the fit's constraints near the middle of the
/// face until both lines agree. The residual is the distance of both lines before the correction.
/// Returns nothing if the figure has no outline like it.
std::optional<CorrectedFit> CorrectDepthByProfile(const Fit& fit, const FloatImage& opacity);

}  // namespace facefit
