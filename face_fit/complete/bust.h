#pragma once

#include <glm/vec3.hpp>

#include "face_fit/complete/canvas.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/image/raster.h"

namespace facefit {

/// The toolkit's own neck, shoulders and clothes, rendered with the photo's camera below the head
/// of an upright person. The images are as large as the canvas.
struct Bust {
  Mask opacity;  ///< coverage of each pixel, 0..1
  /// Share of each pixel that is cloth, 0..1; the rest of what is covered is skin.
  Mask cloth;
  Mask ambient_occlusion;  ///< as its maps are stored: 1 = all ambient light arrives, 0 = none
  /// Mean of unit normals, so up to 1 long; (0, 0, 1), towards the camera, where nothing is drawn.
  VectorImage normal;
  float axis;  ///< x of the body's middle, pixels of the canvas

  /// Returns the half width in a row: the distance from `axis` to the outline on the left or on the
  /// right, pixels, at least 1.
  float HalfWidth(PhotoEdge side, float row) const;
};

/// Draws the bust of the fitted head on a canvas of that size, to whose pixels `pose` projects.
Bust DrawBust(const FittedHead& fitted, const CameraPose& pose, int width, int height);

}  // namespace facefit
