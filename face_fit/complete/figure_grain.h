#pragma once

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

/// Adds grain to inpainted pixels of a figure, as AddGrain (image/grain.h): that of
/// grain.coarsest_on_figure_mm, and less of it in a photo of fewer than grain.pixels_per_mm, whose
/// pixels are as coarse as grain.
void AddGrainToFigure(const Mask& known, Mask amount, float pixels_per_mm, fsm::Image& image);

}  // namespace facefit
