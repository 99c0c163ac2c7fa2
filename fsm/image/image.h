#pragma once

#include <cstdint>
#include <vector>

namespace fsm {

/// 8-bit RGBA, row 0 at the top, no padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< width * height * 4
};

/// The longest side of a picture read, written or drawn.
inline constexpr int kMaxImageSide = 8192;

}  // namespace fsm
