#include "hypermask/base/grey.h"

namespace hypermask {

void ToGrey(const fsm::Image& image, Grey& out) {
  out.width = image.width;
  out.height = image.height;
  out.pixels.resize(image.rgba.size() / 4);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const std::uint8_t* const p = &image.rgba[4 * i];
    out.pixels[i] = static_cast<std::uint8_t>((p[0] + p[1] + p[2]) / 3);
  }
}

}  // namespace hypermask
