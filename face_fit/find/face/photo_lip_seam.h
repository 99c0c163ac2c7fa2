#pragma once

#include <cassert>
#include <utility>
#include <vector>

#include "face_fit/find/network/found_face.h"
#include "fsm/base/side.h"

namespace facefit {

/// The lip seam, the line where closed lips meet, as a photo shows it.
class PhotoLipSeam {
 public:
  /// `pixels`: at equal steps from the mouth's right end to its left. REQUIRES: two or more.
  explicit PhotoLipSeam(std::vector<glm::vec2> pixels) : pixels_(std::move(pixels)) {
    assert(pixels_.size() >= 2);
  }
  /// Returns the pixel at a position along the mouth, clamped to 0 = its right end .. 1 = its left.
  glm::vec2 PixelAt(float along) const;

 private:
  std::vector<glm::vec2> pixels_;
};

/// Follows the lip seam, a dark line, from the person's right corner of the mouth to the left one;
/// the network's own points are a few pixels off, which shows as soon as the lips part.
/// `corners_along`: where along the mouth the network's corners lie, as for PhotoLipSeam.
PhotoLipSeam TraceLipSeam(const fsm::Image& photo, const FoundFace& face,
                          fsm::Sided<float> corners_along);

}  // namespace facefit
