#include "face_fit/find/crop.h"

#include <algorithm>
#include <cmath>

namespace facefit {

namespace {

/// Crop::ToPicture with the cosine and sine of the crop's angle.
glm::vec2 InPicture(const Crop& crop, float c, float s, glm::vec2 p) {
  const glm::vec2 d = (p - 0.5F) * crop.side;
  return crop.centre + glm::vec2(c * d.x - s * d.y, s * d.x + c * d.y);
}

}  // namespace

glm::vec2 Crop::ToPicture(glm::vec2 p) const {
  return InPicture(*this, std::cos(angle), std::sin(angle), p);
}

glm::vec2 Crop::FromPicture(glm::vec2 p) const {
  const glm::vec2 d = p - centre;
  const float c = std::cos(angle), s = std::sin(angle);
  return glm::vec2(c * d.x + s * d.y, -s * d.x + c * d.y) / side + 0.5F;
}

std::vector<float> Crop::Sample(const fsm::Image& image, int pixels, float low, float high) const {
  // Where many pixels fall into one, several of them are averaged.
  const int n = std::clamp(static_cast<int>(std::ceil(side / static_cast<float>(pixels))), 1, 8);
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels) * 3);
  const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
  const float cosine = std::cos(angle), sine = std::sin(angle);
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      glm::vec3 sum(0);
      for (int k = 0; k < n * n; ++k) {
        const glm::vec2 within((static_cast<float>(k % n) + 0.5F) / static_cast<float>(n),
                               (static_cast<float>(k / n) + 0.5F) / static_cast<float>(n));
        const glm::vec2 p =
            InPicture(*this, cosine, sine, (glm::vec2(x, y) + within) / static_cast<float>(pixels));
        if (p.x < 0 || p.y < 0 || p.x >= width || p.y >= height) continue;
        sum += ColourAt(image, p);
      }
      sum = low + sum * (high - low) / (255.0F * static_cast<float>(n * n));
      for (int c = 0; c < 3; ++c) out.push_back(sum[c]);
    }
  }
  return out;
}

}  // namespace facefit
