#include "face_fit/dress/enlarge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

namespace facefit {
namespace {

std::array<float, 4> CatmullRom(float t) {
  return {((-0.5F * t + 1) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1,
          ((-1.5F * t + 2) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
}

std::array<float, 4> BSpline(float t) {
  const float s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

/// Sums `value(index)` over 4 x 4 pixels round a place; the edge goes on outside.
template <typename Value, typename Weights, typename Get>
Value Around(int width, int height, glm::vec2 at, Weights weights, Get get) {
  const glm::vec2 p = glm::clamp(at, glm::vec2(0), glm::vec2(width, height)) - 0.5F;
  const glm::vec2 first = glm::floor(p);
  const auto across = weights(p.x - first.x), down = weights(p.y - first.y);
  Value sum(0);
  for (std::size_t j = 0; j < 4; ++j) {
    const int y = std::clamp(static_cast<int>(first.y + static_cast<float>(j)) - 1, 0, height - 1);
    Value row(0);
    for (std::size_t i = 0; i < 4; ++i) {
      const int x = std::clamp(static_cast<int>(first.x + static_cast<float>(i)) - 1, 0, width - 1);
      row += across[i] * get(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
    }
    sum += down[j] * row;
  }
  return sum;
}

}  // namespace

glm::vec3 SharpColourAt(const fsm::Image& image, glm::vec2 at) {
  const auto colour = [&](std::size_t i) {
    const std::uint8_t* p = &image.rgba[4 * i];
    return glm::vec3(p[0], p[1], p[2]);
  };
  return glm::clamp(Around<glm::vec3>(image.width, image.height, at, CatmullRom, colour), 0.0F,
                    255.0F);
}

float SmoothAt(const FloatImage& field, glm::vec2 at) {
  return Around<float>(field.width, field.height, at, BSpline,
                       [&](std::size_t i) { return field.at[i]; });
}

}  // namespace facefit
