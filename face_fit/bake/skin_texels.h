#pragma once

#include <cmath>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/image/raster.h"
#include "face_fit/surface/mesh_point.h"

namespace facefit {

inline constexpr int kMapSize = 1024;  ///< texels on each side of the skin's map

/// Returns a length on the face in texels of a map of that width, rounded. A face is about 400
/// texels wide on a map of kMapSize.
inline int MmToTexels(float mm, int map_width) {
  constexpr float kTexelsPerMm = 4;
  return static_cast<int>(
      std::lround(mm * kTexelsPerMm * static_cast<float>(map_width) / float{kMapSize}));
}

/// A texel of the skin's map: which point of the base head at rest it shows.
struct SkinTexel {
  /// Stands for a distance to something that is not near.
  static constexpr float kNotNear = std::numeric_limits<float>::infinity();
  MeshPoint on_mesh = {};
  float x_mm = 0;                    ///< from the middle, positive to the person's left
  float y_mm = 0;                    ///< height
  float off_lip_seam_mm = kNotNear;  ///< distance from the lip seam
  float within_lips_mm = -kNotNear;  ///< distance inside the border of the lips, negative outside
  float flank_weight = 0;  ///< 1 on the sides of the head and below the chin, 0 on the face
};
/// kMapSize texels to a side; nothing where the map shows no skin.
using SkinTexels = Raster<std::optional<SkinTexel>>;
/// Returns the texels of the base head's skin.
SkinTexels FindSkinTexels(const ObservedHead& base);

/// Where a photo shows a texel.
struct TexelProjection {
  glm::vec2 pixel;
  float z_mm;    ///< depth, camera's frame
  float facing;  ///< cosine of the normal's angle to the camera
  bool operator==(const TexelProjection&) const = default;
};
/// Of the same texels as SkinTexels; nothing where there is none, or the head itself hides it.
using TexelProjections = Raster<std::optional<TexelProjection>>;

/// Returns where a photo taken with `pose` shows each texel, as if nothing hid it. `texels`: of
/// the skin of fitted.base.
TexelProjections ProjectTexels(const FittedHead& fitted, const SkinTexels& texels,
                               const CameraPose& pose);
/// Removes texels that the head itself hides, as the jaw hides the throat. `projections`:
/// ProjectTexels with the other arguments.
void HideSelfOccluded(const FittedHead& fitted, const CameraPose& pose,
                      TexelProjections& projections);

}  // namespace facefit
