#include "face_fit/image/raster.h"

#include <algorithm>

namespace facefit {

FourPixels::FourPixels(int width, int height, float x, float y) {
  const float px = std::clamp(x - 0.5F, 0.0F, static_cast<float>(width - 1));
  const float py = std::clamp(y - 0.5F, 0.0F, static_cast<float>(height - 1));
  const auto x0 = static_cast<std::size_t>(px), y0 = static_cast<std::size_t>(py);
  const float u = px - static_cast<float>(x0), v = py - static_cast<float>(y0);
  const auto across = static_cast<std::size_t>(width), down = static_cast<std::size_t>(height);
  const std::size_t right = x0 + 1 < across ? 1 : 0, below = y0 + 1 < down ? across : 0;
  const std::size_t first = y0 * across + x0;
  index = {first, first + right, first + below, first + below + right};
  weight = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
}

}  // namespace facefit
