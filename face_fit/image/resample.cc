#include "face_fit/image/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/image/pixels.h"

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

/// Sums `get(index)` over the 4 x 4 pixels around a pixel; outside, the edge is repeated.
template <typename Value, typename Image, typename Weights, typename Get>
Value Around(const Image& image, glm::vec2 pixel, Weights weights, Get get) {
  const int width = image.width, height = image.height;
  const glm::vec2 p = glm::clamp(pixel, glm::vec2(0), glm::vec2(width, height)) - 0.5F;
  const glm::vec2 first = glm::floor(p);
  const auto across = weights(p.x - first.x), down = weights(p.y - first.y);
  Value sum(0);
  for (std::size_t j = 0; j < 4; ++j) {
    const int y = std::clamp(static_cast<int>(first.y + static_cast<float>(j)) - 1, 0, height - 1);
    Value row(0);
    for (std::size_t i = 0; i < 4; ++i) {
      const int x = std::clamp(static_cast<int>(first.x + static_cast<float>(i)) - 1, 0, width - 1);
      row += across[i] * get(image.Index(x, y));
    }
    sum += down[j] * row;
  }
  return sum;
}

}  // namespace

glm::vec3 ColourAt(const fsm::Image& image, glm::vec2 at) {
  return FourPixels(image.width, image.height, at.x, at.y).Mean([&](std::size_t i) {
    return Rgb(image, i);
  });
}

glm::vec3 SharpColourAt(const fsm::Image& image, glm::vec2 at) {
  const auto colour = [&](std::size_t i) { return Rgb(image, i); };
  return glm::clamp(Around<glm::vec3>(image, at, CatmullRom, colour), 0.0F, 255.0F);
}

float SmoothAt(const FloatImage& image, glm::vec2 at) {
  return Around<float>(image, at, BSpline, [&](std::size_t i) { return image[i]; });
}

std::vector<float> Resampled(const fsm::Image& image, glm::vec2 corner, const glm::mat2& axes,
                             int pixels, float low, float high) {
  const float longer = std::max(glm::length(axes[0]), glm::length(axes[1]));
  const int n = std::clamp(static_cast<int>(std::ceil(longer / static_cast<float>(pixels))), 1, 8);
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels) * 3);
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      glm::vec3 sum(0);
      for (int k = 0; k < n * n; ++k) {
        const glm::vec2 within = (glm::vec2(k % n, k / n) + 0.5F) / static_cast<float>(n);
        const glm::vec2 p =
            corner + axes * ((glm::vec2(x, y) + within) / static_cast<float>(pixels));
        if (IsInside(image, p)) sum += ColourAt(image, p);
      }
      sum = low + sum * (high - low) / (255.0F * static_cast<float>(n * n));
      for (int c = 0; c < 3; ++c) out.push_back(sum[c]);
    }
  }
  return out;
}

}  // namespace facefit
