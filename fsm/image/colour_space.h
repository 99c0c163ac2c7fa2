#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace fsm {

/// The transfer curve of sRGB (IEC 61966-2-1) and its inverse, for channels in 0..1. Pure.
inline float SrgbToLinear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}
inline glm::vec3 SrgbToLinear(glm::vec3 encoded) {
  return {SrgbToLinear(encoded.r), SrgbToLinear(encoded.g), SrgbToLinear(encoded.b)};
}
inline float LinearToSrgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

}  // namespace fsm
