#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// What of a figure a photo did not show.
struct Completed {
  bool neck = false;       ///< it ends above the shoulders: neck, shoulders and clothes are drawn
  bool shoulders = false;  ///< it cuts the shoulders: they go on beyond its edges
  bool hair = false;       ///< it cuts the hair above or at a side
};

/// A figure on a canvas that is large enough for head and shoulders.
struct CompletedFigure {
  FigureCutout figure;
  FittedHead head;  ///< its pose is that in the canvas
  Completed completed;
};

/// Draws what the photo cuts off: below and beside it the toolkit's neck, shoulders and clothes, as
/// wide as the figure where the photo ends, in the colours found there and lit by the photo's
/// light; above and beside the head hair. Strands that the lower edge cuts fall on and end softly.
/// Within the photo nothing changes.
CompletedFigure CompleteFigure(const FittedHead& fitted, const FigureCutout& figure);

}  // namespace facefit
