#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// The places of a photo where eyes show between the lids, or teeth between the lips.
class Openings {
 public:
  /// `pixels_per_mm`: on the face. `lips_apart`: the mouth is an opening, too. REQUIRES: `face`
  /// outlives this.
  Openings(const FoundFace& face, float pixels_per_mm, bool lips_apart);
  /// How much of what is seen at a pixel is skin, 0..1.
  float SkinWeight(glm::vec2 pixel) const;

 private:
  struct Opening {
    std::vector<PointIndex> outline;
    float none, all;  ///< pixels outside the outline up to which there is no skin, from which only
    glm::vec2 middle{};
    float radius = 0;  ///< everything beyond is skin
  };
  const FoundFace& face_;
  std::vector<Opening> openings_;
};

/// How many pixels outside (negative: within) a closed line through points of the face `pixel` is.
float SignedDistance(const FoundFace& face, std::span<const PointIndex> outline, glm::vec2 pixel);

}  // namespace facefit
