#pragma once

#include <array>

#include "face_fit/dress/field.h"
#include "face_fit/fit/fit.h"

namespace facefit {

/// A grid over a photo: where its points lie.
struct PhotoGrid {
  glm::vec2 origin;  ///< pixels, of the first point
  float cell;        ///< pixels from one to the next
  int columns, rows;
};

/// What the camera sees of the head's skin at each point of a grid.
struct SkinCover {
  static constexpr float kNone = -1e9F;
  FloatImage depth;                  ///< towards the camera, millimetres; kNone where no skin is
  std::array<FloatImage, 3> motion;  ///< of the skin there by `motion`, 0 where no skin is
};

/// Of the skin above `bottom` (millimetres, the head's frame) and before ears and neck. `motion`:
/// of each vertex of the base head, or empty.
SkinCover CoverWithSkin(const BaseHead& base, const Fit& fit, const PhotoGrid& grid, float bottom,
                        std::span<const glm::vec3> motion = {});

/// Sets what cannot be reached from the edge: eyes and an open mouth lie within the face.
void FillHoles(FloatImage& covered);

}  // namespace facefit
