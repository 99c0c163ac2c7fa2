#pragma once

#include <array>

#include "face_fit/find/head/base_head.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// A grid of points over a photo.
struct PhotoGrid {
  glm::vec2 origin;  ///< pixels, of the first point
  float cell;        ///< pixels from one to the next
  int columns, rows;
  glm::vec2 Pixel(int x, int y) const { return origin + cell * glm::vec2(x, y); }
};

/// What the camera sees of the head's skin at each point of a grid.
struct SkinRaster {
  static constexpr float kNone = -1e9F;
  FloatImage depth;                  ///< towards the camera, millimetres; kNone where no skin is
  std::array<FloatImage, 3> motion;  ///< of the skin there by `motion`, 0 where no skin is
};

/// Rasterises the skin of the fitted head, as a camera in `pose` sees it, above `bottom` (height in
/// the head's frame, millimetres) and in front of ears and neck. `motion`: of each vertex of the
/// base head, millimetres, or empty.
SkinRaster RasterizeSkin(const BaseHead& base, const FittedHead& fitted, const CameraPose& pose,
                         const PhotoGrid& grid, float bottom,
                         std::span<const glm::vec3> motion = {});

}  // namespace facefit
