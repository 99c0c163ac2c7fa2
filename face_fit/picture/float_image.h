#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace facefit {

/// The four pixels round a place and how much each counts, sum 1 (bilinear interpolation). Pixel
/// centres lie at .5; outside the edge is repeated.
struct FourPixels {
  std::array<std::size_t, 4> index;
  std::array<float, 4> weight;
  FourPixels(int width, int height, float x, float y);
  /// `value(index)`: of a pixel.
  auto Mean(auto value) const {
    return (value(index[0]) * weight[0] + value(index[1]) * weight[1]) +
           (value(index[2]) * weight[2] + value(index[3]) * weight[3]);
  }
};

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
  /// Bilinear interpolation, as FourPixels.
  float Between(float x, float y) const {
    return FourPixels(width, height, x, y).Mean([this](std::size_t i) { return at[i]; });
  }
};

}  // namespace facefit
