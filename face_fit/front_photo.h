#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/find/network/found_face.h"

namespace facefit {

// A photo from the front is measured in three kinds of pixels:
// - given: of the photo as it was given;
// - whole: of all of it, set upright; as given for PhotoExtent::kWhole (make_face.h), else scaled
//   down to at most kWorkingSize to a side. HandPoints are in these;
// - close-up: of the part that is worked on, which for PhotoExtent::kWhole is all of it. Faces,
//   figures and fits are in these.

/// A photo from the front and what was found in it beside the face; no head is fitted yet.
struct FrontPhoto {
  fsm::Image image;  ///< what is worked on, upright
  FigureCutout figure = {};
  int face_count = 0;   ///< number of faces found
  int orientation = 1;  ///< EXIF orientation of the photo as given
  float closeup_per_given_pixel = 1;
  glm::ivec2 whole_size_px{0};
};

/// The face in a photo from the front.
struct FrontFace {
  FoundFace found;
  std::optional<Occlusion> occlusion = {};  ///< nothing if it was not examined
  glm::vec2 nose_whole_px{0};
};

/// A photo from the front, ready to be made a face of.
struct PreparedFront {
  FrontPhoto photo;
  std::optional<FrontFace> face;  ///< nothing if none was found
};

}  // namespace facefit
