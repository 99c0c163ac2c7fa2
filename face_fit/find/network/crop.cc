#include "face_fit/find/network/crop.h"

#include <cmath>

#include "face_fit/picture/plane.h"

namespace facefit {

glm::vec2 Crop::ToPicture(glm::vec2 p) const { return centre + Rotated((p - 0.5F) * size, angle); }

glm::vec2 Crop::FromPicture(glm::vec2 p) const { return Rotated(p - centre, -angle) / size + 0.5F; }

std::vector<float> Crop::Sample(const fsm::Image& image, int pixels, float low, float high) const {
  const float c = size * std::cos(angle), s = size * std::sin(angle);
  return Resampled(image, ToPicture({0, 0}), glm::mat2(c, s, -s, c), pixels, low, high);
}

}  // namespace facefit
