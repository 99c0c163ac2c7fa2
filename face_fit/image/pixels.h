#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

// Colours, and pixels by their number, row by row from the top. Pure; thread: any.

inline glm::vec3 Rgb(const fsm::Image& image, std::size_t i) {
  const std::uint8_t* p = &image.rgba[4 * i];
  return {p[0], p[1], p[2]};
}

/// Rounds a channel to 0..255; values beyond are clamped.
inline std::uint8_t Byte(float v) {
  return static_cast<std::uint8_t>(std::clamp(v, 0.0F, 255.0F) + 0.5F);
}
inline void SetRgb(fsm::Image& image, std::size_t i, glm::vec3 colour) {
  for (int c = 0; c < 3; ++c) image.rgba[4 * i + static_cast<std::size_t>(c)] = Byte(colour[c]);
}

/// Returns whether a pixel lies in an image.
inline bool IsInside(const fsm::Image& image, glm::vec2 p) {
  return p.x >= 0 && p.y >= 0 && p.x < static_cast<float>(image.width) &&
         p.y < static_cast<float>(image.height);
}

/// Returns the brightness of a colour, in its unit; red weighs more than in human vision, because
/// faces are red.
inline float Brightness(glm::vec3 c) { return 0.3F * c.r + 0.5F * c.g + 0.2F * c.b; }

/// Returns the colours of all pixels, 0..255.
inline VectorImage Colours(const fsm::Image& image) {
  VectorImage out(image.width, image.height);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = Rgb(image, i);
  return out;
}

/// Returns a length in pixels, rounded, but not less than `least`.
inline int MmToPixels(float mm, float pixels_per_mm, int least = 1) {
  return std::max(static_cast<int>(std::lround(mm * pixels_per_mm)), least);
}

}  // namespace facefit
