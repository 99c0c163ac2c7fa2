#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

inline constexpr int kDiscSide = 160;

/// Calls `f(pixel centre)` for the colour of each pixel, 0..255.
template <typename F>
fsm::Image Painted(F f) {
  fsm::Image image{.width = kDiscSide, .height = kDiscSide, .rgba = {}};
  for (int y = 0; y < kDiscSide; ++y) {
    for (int x = 0; x < kDiscSide; ++x) {
      const glm::vec3 c = f(glm::vec2(x, y) + 0.5F);
      for (int k = 0; k < 3; ++k) image.rgba.push_back(static_cast<std::uint8_t>(c[k] + 0.5F));
      image.rgba.push_back(255);
    }
  }
  return image;
}

template <typename F>
FloatImage FieldOf(F f) {
  FloatImage field(kDiscSide, kDiscSide);
  for (int y = 0; y < kDiscSide; ++y) {
    for (int x = 0; x < kDiscSide; ++x) field(x, y) = f(glm::vec2(x, y) + 0.5F);
  }
  return field;
}

/// A disc, soft over `soft` pixels.
inline float Disc(glm::vec2 p, float radius, float soft) {
  const float off = radius - glm::distance(p, glm::vec2(kDiscSide / 2));
  return glm::clamp(0.5F + off / soft, 0.0F, 1.0F);
}

inline constexpr glm::vec3 kHair(70, 45, 20), kSky(120, 160, 220);

}  // namespace facefit
