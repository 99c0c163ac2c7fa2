#pragma once

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

/// Adds grain (pores, hair, beard) to inpainted pixels, which are too smooth, taken from the pixel
/// mirrored at the edge of the known pixels. `known`: 1 where a pixel was known, 0 where it was
/// inpainted; `amount`: of grain, 0..1; `reach`: pixels over which brightness varies as grain;
/// grain is carried up to eight times as far.
void AddGrain(const Mask& known, const Mask& amount, int reach, fsm::Image& image);
/// The same of a figure: grain of grain.coarsest_on_figure_mm, and less of it in a photo of fewer
/// than grain.pixels_per_mm, whose pixels are as coarse as grain.
void AddGrainToFigure(const Mask& known, Mask amount, float pixels_per_mm, fsm::Image& image);

}  // namespace facefit
