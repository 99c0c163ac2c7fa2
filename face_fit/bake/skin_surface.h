#pragma once

#include "face_fit/fit/fitted_head.h"
#include "face_fit/surface/visible_surface.h"

namespace facefit {

/// Returns the skin of the fitted head that a camera in `pose` sees on a grid of pixels: above
/// `bottom_mm` (height in the head's frame), in front of ears and neck, and not at a grazing angle.
VisibleSurface VisibleSkin(const FittedHead& fitted, const CameraPose& pose, const SampleGrid& grid,
                           float bottom_mm);

}  // namespace facefit
