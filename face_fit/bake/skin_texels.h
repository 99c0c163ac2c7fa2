#pragma once

#include <cmath>
#include <glm/vec2.hpp>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

inline constexpr int kMapSize = 1024;     ///< texels on each side of the skin's map
inline constexpr float kBrowsEndMm = 27;  ///< above the nasion

/// Returns a length on the face in texels of a map of that width, rounded. A face is about 400
/// texels wide on a map of kMapSize.
inline int TexelsOf(float mm, int map_width) {
  constexpr float kTexelsPerMm = 4;
  return static_cast<int>(
      std::lround(mm * kTexelsPerMm * static_cast<float>(map_width) / float{kMapSize}));
}

/// A texel of the skin's map: its pixel in a photo and its position on the base head at rest.
struct SkinTexel {
  static constexpr float kNotNear = 1e9F;  ///< stands for a distance to something that is not near
  glm::vec2 pixel{0};
  float facing = -1;             ///< cosine of the normal's angle to the camera; -1 = not seen
  float outward_mm2 = -1;        ///< squared distance from the head's vertical axis; -1 = no skin
  float x_mm = 0;                ///< from the middle, positive to the person's left
  float y_mm = -kNotNear;        ///< height
  float off_seam_mm = kNotNear;  ///< distance from the line where the lips meet
  float within_lips_mm = -kNotNear;  ///< distance inside the border of the lips, negative outside
  float side_weight = 0;  ///< 1 on the sides of the head and below the chin, 0 on the face
};
/// kMapSize texels to a side.
using SkinTexels = Raster<SkinTexel>;

/// Whether skin that the head itself hides, as the jaw hides the throat, counts as not seen (facing
/// -1).
enum class SelfHidden { kIgnored, kNotSeen };
/// Returns for each texel of the skin's map its pixel in a photo taken with `pose`. Texels that no
/// triangle covers keep the values of a new SkinTexel.
SkinTexels ProjectSkin(const FittedHead& fitted, const CameraPose& pose, SelfHidden self_hidden);

}  // namespace facefit
