#include "face_fit/find/network/crop.h"

#include <cmath>

namespace facefit {

glm::vec2 Crop::ToPicture(glm::vec2 p) const {
  const glm::vec2 d = (p - 0.5F) * size;
  const float c = std::cos(angle), s = std::sin(angle);
  return centre + glm::vec2(c * d.x - s * d.y, s * d.x + c * d.y);
}

glm::vec2 Crop::FromPicture(glm::vec2 p) const {
  const glm::vec2 d = p - centre;
  const float c = std::cos(angle), s = std::sin(angle);
  return glm::vec2(c * d.x + s * d.y, -s * d.x + c * d.y) / size + 0.5F;
}

std::vector<float> Crop::Sample(const fsm::Image& image, int pixels, float low, float high) const {
  const float c = size * std::cos(angle), s = size * std::sin(angle);
  return Resampled(image, ToPicture({0, 0}), glm::mat2(c, s, -s, c), pixels, low, high);
}

}  // namespace facefit
