#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// The places of a photo where eyes show between the lids, or teeth between the lips.
class PhotoOpenings {
 public:
  /// `pixels_per_mm`: on the face. `lips_apart`: the mouth is an opening, too.
  PhotoOpenings(const FoundFace& face, float pixels_per_mm, bool lips_apart);
  /// How much of what is seen at a pixel is skin, 0..1.
  float SkinWeight(glm::vec2 pixel) const;

 private:
  struct Opening {
    std::vector<glm::vec2> outline;
    float no_skin_px;   ///< up to so far outside the outline there is no skin
    float all_skin_px;  ///< from so far outside on there is only skin
    glm::vec2 middle{};
    float radius = 0;  ///< everything beyond is skin
  };
  std::vector<Opening> openings_;
};

}  // namespace facefit
