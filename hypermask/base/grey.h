#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsm/image/image.h"

namespace hypermask {

/// A picture of brightness: 8 bit, row 0 at the top, no padding. Its y points down.
struct Grey {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels{};  ///< width * height

  Grey() = default;
  Grey(int w, int h, std::uint8_t value = 0)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Brightness as the mean of red, green and blue, so that infrared light, which cameras record in
/// any of the three, counts whichever it is. `out`'s memory is used again.
void ToGrey(const fsm::Image& image, Grey& out);

}  // namespace hypermask
