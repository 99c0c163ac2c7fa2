#pragma once

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

/// Returns the figure's colours without the background's light in its edge, continued beyond the
/// edge.
fsm::Image ForegroundColours(const fsm::Image& photo, const Mask& opacity);

/// A figure cut out of a photo: its colours, continued beyond its outline, and its opacity, 0..1.
struct FigureCutout {
  fsm::Image colours;
  Mask opacity;
};
/// Cuts out a figure: its opacity is 1 inside, 0 outside, between at soft edges and strands of
/// hair; its colours are ForegroundColours. `person`: a rough estimate of the opacity, 0..1; pixels
/// far from its outline keep it.
FigureCutout CutOutFigure(const fsm::Image& photo, const Mask& person);

}  // namespace facefit
