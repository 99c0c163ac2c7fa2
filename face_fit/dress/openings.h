#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_fit/find/face_finder.h"

namespace facefit {

/// Where a photo shows something between lids or lips that is not skin.
class Openings {
 public:
  /// `pixels_per_mm` on the face; without `lips_apart` a mouth is no opening. `face` outlives it.
  Openings(const FoundFace& face, float pixels_per_mm, bool lips_apart);
  /// How much of what is seen at a pixel is skin, 0..1.
  float Skin(glm::vec2 pixel) const;

 private:
  struct Opening {
    std::vector<int> outline;
    float none, all;  ///< pixels outside the outline up to which there is no skin, from which only
    glm::vec2 middle{};
    float radius = 0;  ///< everything beyond is skin
  };
  const FoundFace& face_;
  std::vector<Opening> openings_;
};

}  // namespace facefit
