#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_fit/image/resample.h"

namespace facefit {

/// A rotated square of an image, as it is shown to a network. Pure; thread: any.
struct NetworkCrop {
  glm::vec2 centre;
  float size = 0;
  float angle_rad = 0;  ///< angle of the square's x axis in the image, y down

  /// Transforms from the square, 0..1 on both axes, to the image and back.
  glm::vec2 ToImage(glm::vec2 p) const;
  glm::vec2 FromImage(glm::vec2 p) const;
  /// Returns `pixels` x `pixels` RGB values in low..high; `low` outside the image.
  std::vector<float> Sample(const fsm::Image& image, int pixels, float low, float high) const;
};

}  // namespace facefit
