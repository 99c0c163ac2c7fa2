#include "face_fit/find/network/network_crop.h"

#include <cmath>

#include "face_fit/image/plane.h"

namespace facefit {

glm::vec2 NetworkCrop::ToImage(glm::vec2 p) const {
  return centre + Rotated((p - 0.5F) * size, angle_rad);
}

glm::vec2 NetworkCrop::FromImage(glm::vec2 p) const {
  return Rotated(p - centre, -angle_rad) / size + 0.5F;
}

std::vector<float> NetworkCrop::Sample(const fsm::Image& image, int pixels, float low,
                                       float high) const {
  const float c = size * std::cos(angle_rad), s = size * std::sin(angle_rad);
  return Resampled(image, ToImage({0, 0}), glm::mat2(c, s, -s, c), pixels, low, high);
}

}  // namespace facefit
