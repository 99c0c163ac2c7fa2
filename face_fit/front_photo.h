#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// A photo from the front and what was found in it; no head is fitted yet.
struct FrontPhoto {
  fsm::Image photo;  ///< what is worked on, upright
  /// In pixels of `photo`; nothing if none was found. A user's points may replace it.
  std::optional<FoundFace> face = {};
  FigureCutout figure = {};
  Occlusion occlusion = {};  ///< of the face
  int faces = 0;             ///< number of faces found
  int orientation = 1;       ///< EXIF orientation of the photo as given
  float scale = 1;           ///< pixels of `photo` for each pixel of the photo as given
  /// The pixel of the nose, and the size, of the whole upright photo: as given for
  /// PhotoExtent::kWhole (make_face.h), else scaled down to at most kWorkingSize to a side.
  glm::vec2 nose{0};
  glm::ivec2 whole_size{0};
};

}  // namespace facefit
