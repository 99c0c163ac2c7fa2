#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "fsm/image/image.h"

namespace facefit {

/// Shows in grey what `brightness` says of each pixel's centre.
template <typename F>
fsm::Image GreyImage(int side, F brightness) {
  fsm::Image image{.width = side, .height = side, .rgba = {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto v = static_cast<std::uint8_t>(
          brightness(glm::vec2(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F)));
      image.rgba.insert(image.rgba.end(), {v, v, v, 255});
    }
  }
  return image;
}

/// A photo that shows nothing, for faces of which only points matter.
inline fsm::Image EvenGreyImage(int side) {
  return GreyImage(side, [](glm::vec2) { return 128; });
}

}  // namespace facefit
