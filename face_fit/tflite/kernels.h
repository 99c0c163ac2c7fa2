#pragma once

#include <span>

#include "face_fit/tflite/model.h"

namespace facefit {

/// Where a filter begins: rows and columns of zeros before the input.
struct Padding {
  int rows = 0, columns = 0;
};
Padding PaddingOf(const op::Window& window, const Shape& in, const Shape& out, int filter_rows,
                  int filter_columns);

// The operators' arithmetic. Sizes have been checked; `out` has its shape and its room.
void Convolve(const op::Window& window, const Tensor& in, const Tensor& filter, const float* bias,
              Tensor& out);
void DepthwiseConv(const op::Window& window, const Tensor& in, const Tensor& filter,
                   const float* bias, Tensor& out);
/// Each input pixel paints a block of `filter` size, side by side.
void TransposeConv(const Tensor& in, const Tensor& filter, const float* bias, Tensor& out);
void Pool(const op::Pooling& pooling, const Tensor& in, Tensor& out);
void ResizeBilinear(const op::ResizeBilinear& resize, const Tensor& in, Tensor& out);
void Pad(const Tensor& in, const std::vector<std::int32_t>& by, Tensor& out);
/// Takes of each axis every `by`-th place from `begin` on. Four numbers each.
void StridedSlice(const Tensor& in, std::span<const std::int32_t> begin,
                  std::span<const std::int32_t> by, Tensor& out);

// MediaPipe's operators for looking closer at parts of a face. A matrix is 4 x 4, row by row, of
// which the first two rows count: they take x, y, 0, 1 of the part to x and y of the whole.

/// `points`: x, y, z of each.
void LandmarksToMatrix(const op::LandmarksToMatrix& crop, const Tensor& points, Tensor& matrix);
/// Cuts a part out, bilinearly. Pixels are squares whose middles lie at halves; what lies beyond
/// the middles of the outermost ones is 0.
void TransformTensor(const Tensor& in, const Tensor& matrix, Tensor& out);
/// Takes points (x, y, or x, y, z with z left as it is) from the part to the whole.
void TransformLandmarks(const Tensor& in, const Tensor& matrix, Tensor& out);

/// `b` has the shape of `a`, or is one number for each channel, or one.
template <typename F>
void Combine(const Tensor& a, const Tensor& b, Tensor& out, F f) {
  const std::size_t n = a.values.size();
  const std::size_t m = b.values.size();
  const float* left = a.values.data();
  const float* right = b.values.data();
  float* to = out.values.data();
  if (m == n) {
    for (std::size_t i = 0; i < n; ++i) to[i] = f(left[i], right[i]);
    return;
  }
  for (std::size_t i = 0; i < n; i += m) {
    for (std::size_t k = 0; k < m; ++k) to[i + k] = f(left[i + k], right[k]);
  }
}
void Activate(Activation activation, std::vector<float>& values);

}  // namespace facefit
