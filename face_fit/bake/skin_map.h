#pragma once

#include "face_fit/bake/skin_texels.h"
#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

/// The skin's map while photos are laid on it, kMapSize texels to a side.
struct SkinMap {
  fsm::Image image = fsm::FilledImage(kMapSize, kMapSize);
  Mask coverage{kMapSize, kMapSize};    ///< how well photos show each texel
  Mask grain_lost{kMapSize, kMapSize};  ///< share of its grain that each texel lost
  /// 1 where the front photo shows no opening, 0 between lids or lips.
  Mask outside_openings{kMapSize, kMapSize, 1};
};

}  // namespace facefit
