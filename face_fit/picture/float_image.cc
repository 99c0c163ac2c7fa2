#include "face_fit/picture/float_image.h"

#include <algorithm>

namespace facefit {

float FloatImage::Between(float x, float y) const {
  const float px = std::clamp(x - 0.5F, 0.0F, static_cast<float>(width - 1));
  const float py = std::clamp(y - 0.5F, 0.0F, static_cast<float>(height - 1));
  const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const float u = px - static_cast<float>(x0), v = py - static_cast<float>(y0);
  return (at[Index(x0, y0)] * (1 - u) + at[Index(x1, y0)] * u) * (1 - v) +
         (at[Index(x0, y1)] * (1 - u) + at[Index(x1, y1)] * u) * v;
}

}  // namespace facefit
