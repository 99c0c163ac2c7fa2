#pragma once

#include <optional>

#include "face_fit/fit/fit.h"
#include "face_fit/image/raster.h"

namespace facefit {

/// Finds the profile of the fitted head (brow, nose, lips, chin) on the outline of a figure
/// (`opacity`: 1 = figure), and corrects the depth of the fit's constraints near the middle of the
/// face until the two agree. Returns nothing if nothing of the outline resembles the profile.
std::optional<FaceFit> CorrectDepthByProfile(const Mask& opacity, FaceFit fit);

}  // namespace facefit
