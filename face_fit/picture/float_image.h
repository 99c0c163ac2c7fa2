#pragma once

#include <cstddef>
#include <vector>

namespace facefit {

/// A number for each pixel of a picture, row 0 at the top. Also used for grids of other things.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> at;  ///< width * height
  FloatImage(int w, int h, float value = 0)
      : width(w), height(h), at(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  /// Bilinear interpolation; pixel centres lie at .5, outside the edge is repeated.
  float Between(float x, float y) const;
};

}  // namespace facefit
