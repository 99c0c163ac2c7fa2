#pragma once

#include "face_fit/bake/chin.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"
#include "face_fit/surface/visible_surface.h"

namespace facefit {

/// The skin on the sheet's grid.
struct GridSkin {
  /// `rim_cells`: how far behind the skin's edge the sheet goes on.
  GridSkin(const VisibleSurface& surface, int rim_cells);
  int rim;             ///< cells
  FloatImage depth;    ///< towards the camera, millimetres
  FloatImage covered;  ///< 1 where there is skin
  FloatImage within;   ///< how much of what is nearer than the rim is skin, 0..1
  FloatImage inner;  ///< 1 where skin is not near its edge, where each point has a depth of its own
};

/// Depth of the sheet, millimetres towards the camera: just under the skin, from there gently back
/// to the outline. `shown`: the figure's opacity, 0..1.
FloatImage SheetDepth(const FittedHead& fitted, const SampleGrid& grid, const Chin& chin,
                      const GridSkin& skin, const FloatImage& shown);

}  // namespace facefit
