#pragma once

#include <cmath>
#include <glm/vec2.hpp>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

inline constexpr int kMapSize = 1024;     ///< texels on each side of the skin's map
inline constexpr float kBrowsEndMm = 27;  ///< above the nasion

/// A length on the face in texels of a map that is so many texels wide. A face is some 400 texels
/// wide on a map of kMapSize.
inline int TexelsOf(float mm, int map_width) {
  constexpr float kTexelsPerMm = 4;
  return static_cast<int>(
      std::lround(mm * kTexelsPerMm * static_cast<float>(map_width) / float{kMapSize}));
}

/// A texel of the skin's map: where it lies in a photo and on the base head at rest.
struct SkinTexel {
  static constexpr float kNotNear = 1e9F;  ///< millimetres from what is not near the texel
  glm::vec2 pixel{0};
  float facing = -1;       ///< cosine of its normal to the direction of the camera; -1 = not seen
  float outward_mm2 = -1;  ///< square of its distance from the head's upright axis; -1 = no skin
  float x_mm = 0;          ///< to the person's left of the middle
  float above_brows_mm = -1;
  float off_seam_mm = kNotNear;      ///< from where the lips meet
  float within_lips_mm = -kNotNear;  ///< of the border of the lips, negative outside
  float aside = 0;  ///< 1 on the sides of the head and below the chin, 0 on the face
};
/// kMapSize texels to a side.
using SkinTexels = Raster<SkinTexel>;

/// Whether skin that the head itself covers, as the jaw covers the throat, counts as not seen
/// (facing -1).
enum class SelfHidden { kIgnored, kNotSeen };
/// For each texel of the skin's map its place in a photo taken with `pose`. Texels that no triangle
/// covers keep the values of a new SkinTexel.
SkinTexels ProjectSkin(const FittedHead& fitted, const CameraPose& pose, SelfHidden self_hidden);

}  // namespace facefit
