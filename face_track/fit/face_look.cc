#include "face_track/fit/face_look.h"

#include <algorithm>
#include <cmath>

#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"

namespace facetrack {
namespace {

constexpr int kAround = 4;       // pixels to either side that a place is compared with
constexpr float kNoise = 4;      // of 255: what deviates less is no feature
constexpr int kBlur[] = {2, 1};  // of the levels

facefit::FloatImage Normalised(const facefit::FloatImage& grey, int blur) {
  facefit::FloatImage look = facefit::Blurred(facefit::Blurred(grey, blur), blur);
  facefit::FloatImage squares = look;
  for (float& v : squares.values) v *= v;
  const auto mean = facefit::Blurred(look, kAround);
  squares = facefit::Blurred(squares, kAround);
  for (std::size_t i = 0; i < look.values.size(); ++i) {
    const float variance = std::max(squares.values[i] - mean.values[i] * mean.values[i], 0.0F);
    look.values[i] = (look.values[i] - mean.values[i]) / std::sqrt(variance + kNoise * kNoise);
  }
  return look;
}

facefit::FloatImage Grey(const fsm::Image& picture, const facefit::NetworkCrop& crop) {
  const auto colours = crop.Sample(picture, FaceLook::kSide, 0, 255);
  facefit::FloatImage grey(FaceLook::kSide, FaceLook::kSide);
  for (std::size_t i = 0; i < grey.values.size(); ++i) {
    grey.values[i] = facefit::Brightness({colours[3 * i], colours[3 * i + 1], colours[3 * i + 2]});
  }
  return grey;
}

}  // namespace

FaceLook::FaceLook(const fsm::Image& picture, const facefit::NetworkCrop& crop)
    : crop_(crop), levels_{facefit::FloatImage(0, 0), facefit::FloatImage(0, 0)} {
  const auto grey = Grey(picture, crop);
  for (std::size_t k = 0; k < kLevels; ++k) levels_[k] = Normalised(grey, kBlur[k]);
}

glm::vec3 FaceLook::At(std::size_t level, glm::vec2 place) const {
  const glm::vec2 p = crop_.FromImage(place) * static_cast<float>(kSide) - 0.5F;
  const float x = std::clamp(p.x, 0.0F, kSide - 1.001F), y = std::clamp(p.y, 0.0F, kSide - 1.001F);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const float u = x - static_cast<float>(x0), v = y - static_cast<float>(y0);
  const float* at = &levels_[level].values[levels_[level].Index(x0, y0)];
  const float a = at[0], b = at[1], c = at[kSide], d = at[kSide + 1];
  return {(a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v,
          (b - a) * (1 - v) + (d - c) * v, (c - a) * (1 - u) + (d - b) * u};
}

glm::mat2 FaceLook::Scale() const {
  const float scale = static_cast<float>(kSide) / crop_.size;
  const float c = scale * std::cos(crop_.angle_rad), s = scale * std::sin(crop_.angle_rad);
  return {c, -s, s, c};
}

}  // namespace facetrack
