#pragma once

#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

/// The opacity of a figure: 1 within, 0 outside, between at soft edges and strands of hair.
/// `person`: where it is roughly, 0..1; pixels where that is certain keep it.
FloatImage Matte(const fsm::Image& photo, const FloatImage& person);

/// The figure's own colours: light of the background is removed from its edge, and its colours are
/// continued beyond the edge.
fsm::Image ForegroundColours(const fsm::Image& photo, const FloatImage& opacity);

/// A figure cut out of a photo: its colours, continued beyond its outline, and its opacity, 0..1.
struct FigureCutout {
  fsm::Image colours;
  FloatImage opacity;
};
/// `person`: as of Matte.
FigureCutout CutOutFigure(const fsm::Image& photo, const FloatImage& person);

}  // namespace facefit
