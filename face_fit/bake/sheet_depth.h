#pragma once

#include "face_fit/bake/chin.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/image/raster.h"
#include "face_fit/surface/visible_surface.h"

namespace facefit {

/// The visible skin on the sheet's grid.
struct SkinOnGrid {
  /// `rim_cells`: width of the sheet's rim behind the edge of the skin.
  SkinOnGrid(const VisibleSurface& surface, int rim_cells);
  int rim;           ///< cells
  FloatImage depth;  ///< towards the camera, millimetres
  Mask covered;      ///< 1 where there is skin
  Mask within;       ///< share of skin within `rim` of each point, 0..1
  /// 1 for skin away from its edge; only there each point has a depth of its own.
  Mask inner;
};

/// Returns the depth of the sheet, millimetres towards the camera, camera's frame: just below the
/// skin, and from there gently back to the outline. `shown`: opacity of the figure, 0..1.
FloatImage SheetDepth(const CameraPose& pose, const SampleGrid& grid, const Chin& chin,
                      const SkinOnGrid& skin, const Mask& shown);

}  // namespace facefit
