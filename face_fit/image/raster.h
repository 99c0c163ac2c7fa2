#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace facefit {

/// The four pixels around a point and their weights, sum 1 (bilinear interpolation). Pixel centres
/// lie at .5; outside, the edge is repeated.
struct FourPixels {
  std::array<std::size_t, 4> index;
  std::array<float, 4> weight;
  FourPixels(int width, int height, float x, float y);
  /// Returns the weighted mean of `value(index)` over the pixels.
  auto Mean(auto value) const {
    return (value(index[0]) * weight[0] + value(index[1]) * weight[1]) +
           (value(index[2]) * weight[2] + value(index[3]) * weight[3]);
  }
};

/// Calls `f(x, y, i)` for each pixel of an image, row by row; `i`: its index.
void ForEachPixel(int width, int height, auto f) {
  std::size_t i = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) f(x, y, i++);
  }
}

/// A value for each pixel of an image, row 0 at the top. Also used for other grids.
template <typename T>
struct Raster {
  int width = 0, height = 0;
  std::vector<T> values;  ///< width * height
  Raster() = default;
  Raster(int w, int h, T value = {})
      : width(w),
        height(h),
        values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
  /// Returns a raster of `value(x, y)`, evaluated row by row.
  static Raster From(int w, int h, auto value) {
    Raster out(w, h);
    ForEachPixel(w, h, [&](int x, int y, std::size_t i) { out[i] = value(x, y); });
    return out;
  }
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  std::size_t size() const { return values.size(); }
  T& operator[](std::size_t i) { return values[i]; }
  const T& operator[](std::size_t i) const { return values[i]; }
  T& operator()(int x, int y) { return values[Index(x, y)]; }
  const T& operator()(int x, int y) const { return values[Index(x, y)]; }
  /// Bilinear interpolation, as FourPixels.
  T SampleAt(float x, float y) const {
    return FourPixels(width, height, x, y).Mean([this](std::size_t i) { return values[i]; });
  }
};
using FloatImage = Raster<float>;
/// How much of each pixel is what the mask is named for: 0 nothing, 1 all. As alpha of an image it
/// is 0..255.
using Mask = FloatImage;
using VectorImage = Raster<glm::vec3>;

}  // namespace facefit
