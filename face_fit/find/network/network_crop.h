#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_fit/picture/resample.h"

namespace facefit {

/// A turned square of a picture, as a network is shown it. Pure; thread: any.
struct NetworkCrop {
  glm::vec2 centre;
  float size = 0;
  float angle_rad = 0;  ///< of the square's x axis in the picture, whose y runs down

  /// From the square, 0..1 on both axes, to the picture and back.
  glm::vec2 ToPicture(glm::vec2 p) const;
  glm::vec2 FromPicture(glm::vec2 p) const;
  /// `pixels` x `pixels` RGB, each in low..high; outside the picture `low`.
  std::vector<float> Sample(const fsm::Image& image, int pixels, float low, float high) const;
};

}  // namespace facefit
