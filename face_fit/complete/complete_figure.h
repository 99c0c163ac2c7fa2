#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Which parts of a figure lay beyond its photo and were drawn.
struct Completed {
  bool neck = false;  ///< the photo ends above the shoulders: neck, shoulders and clothes are drawn
  bool shoulders = false;  ///< an edge cuts the shoulders: they are continued beyond it
  bool hair = false;       ///< the upper, left or right edge cuts hair: it is continued beyond it
};

/// A figure on a canvas that is large enough for head and shoulders.
struct CompletedFigure {
  FigureCutout figure;
  CameraPose pose;  ///< the fitted head's, to pixels of the canvas
  Completed completed;
};

/// Draws what the photo cuts off; canvas.h has a drawing of the regions. Below the photo and beside
/// it the toolkit's neck, shoulders and clothes continue the figure at its width, in the colours
/// found along the photo's edge and lit by the photo's light. Hair is continued above and beside
/// the head; strands that the lower edge cuts hang on and end softly. Within the photo colours stay
/// where the figure is seen, and opacity changes in two places: tips of a collar beside a neck
/// become transparent, and in the lowest edge.band_mm (tables/photo_look.txt) opacity rises where
/// the drawn body continues below.
CompletedFigure CompleteFigure(const FittedHead& fitted, const FigureCutout& figure);

}  // namespace facefit
