#pragma once

#include <glm/vec2.hpp>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

inline constexpr int kMapSize = 1024;   ///< texels on each side of the skin's map
inline constexpr float kBrowsEnd = 27;  ///< millimetres above the nasion

/// A texel of the skin's map: where it lies in a photo and on the base head at rest.
struct SkinTexel {
  glm::vec2 pixel{0};
  float facing = -1;      ///< cosine of its normal to the direction of the camera; -1 = not seen
  float outward = -1e9F;  ///< square of its distance from the head's upright axis
  float x_mm = 0;         ///< to the person's left of the middle
  float above_brows_mm = -1;
  float off_seam_mm = 1e9F;      ///< from where the lips meet
  float within_lips_mm = -1e9F;  ///< of the border of the lips, negative outside
  float aside = 0;               ///< 1 on the sides of the head and below the chin, 0 on the face
};
/// kMapSize texels to a side.
using SkinTexels = Raster<SkinTexel>;

/// For each texel of the skin's map its place in a photo taken with `pose`. `hidden`: skin that the
/// head itself covers, as the jaw covers the throat, counts as not seen (facing -1). Texels that no
/// triangle covers keep the values of a new SkinTexel.
SkinTexels ProjectSkin(const FittedHead& fitted, const CameraPose& pose, bool hidden);

}  // namespace facefit
