#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_fit/find/network/found_face.h"

namespace facefit {

/// The regions of a photo that show eyes between the lids, or teeth between the lips.
class PhotoOpenings {
 public:
  /// `pixels_per_mm`: on the face.
  PhotoOpenings(const FoundFace& face, float pixels_per_mm);
  /// Returns the share of a pixel that is skin, 0..1.
  float SkinShare(glm::vec2 pixel) const;

 private:
  struct Opening {
    std::vector<glm::vec2> outline;
    float no_skin_px;   ///< distance outside the outline below which nothing is skin
    float all_skin_px;  ///< distance from which all is skin; the same where nothing fades
    glm::vec2 middle{};
    float radius = 0;  ///< everything farther from `middle` is skin
  };
  std::vector<Opening> openings_;
};

}  // namespace facefit
