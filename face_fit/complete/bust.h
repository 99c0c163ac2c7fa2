#pragma once

#include <glm/vec3.hpp>

#include "face_fit/complete/canvas.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// The toolkit's own neck, shoulders and clothes, as the photo's camera would see them below the
/// head if the person stood upright. Each picture is as large as the one they are drawn for.
struct Bust {
  FloatImage opacity;   ///< how much of a pixel it covers, 0..1
  FloatImage cloth;     ///< how much of a pixel is cloth; the rest of what is covered is skin
  FloatImage openness;  ///< how much light from all around arrives, 0..1
  VectorImage normal;   ///< unit; where nothing is, towards the camera
  float axis;           ///< pixels from the left: the middle of the body

  /// How far it reaches from its axis in a row, pixels, to the left or to the right.
  float HalfWidth(PhotoEdge towards, float row) const;
};

Bust DrawBust(const FittedHead& fitted, int width, int height);

}  // namespace facefit
