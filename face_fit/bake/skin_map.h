#pragma once

#include "face_fit/bake/skin_texels.h"
#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

/// The skin's map while photos are laid on it, kMapSize texels to a side.
struct SkinMap {
  fsm::Image image = fsm::FilledImage(kMapSize, kMapSize);
  Mask coverage{kMapSize, kMapSize};    ///< how well photos show each texel
  Mask grain_lost{kMapSize, kMapSize};  ///< share of its grain that each texel lost
  /// What the first photo does not show between lids or between lips.
  Mask outside_openings{kMapSize, kMapSize, 1};
};

}  // namespace facefit
