#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// The face in a photo from the front, pixels of FrontPhoto::photo.
struct FrontFace {
  FoundFace found;
  std::optional<Occlusion> occlusion = {};  ///< nothing if it was not examined
  glm::vec2 nose{0};                        ///< in the whole photo (FrontPhoto::whole_size)
};

/// A photo from the front and what was found in it; no head is fitted yet.
struct FrontPhoto {
  fsm::Image photo;  ///< what is worked on, upright
  std::optional<FrontFace> face = {};
  FigureCutout figure = {};
  int face_count = 0;   ///< number of faces found
  int orientation = 1;  ///< EXIF orientation of the photo as given
  float scale = 1;      ///< pixels of `photo` for each pixel of the photo as given
  /// Pixels of the whole upright photo: as given for PhotoExtent::kWhole (make_face.h), else scaled
  /// down to at most kWorkingSize to a side.
  glm::ivec2 whole_size{0};
};

}  // namespace facefit
