#pragma once

#include "face_fit/net/model.h"

namespace facefit {

/// Where a filter begins: rows and columns of zeros before the input.
struct Padding {
  int rows = 0, columns = 0;
};
Padding PaddingOf(const Step& step, const Shape& in, const Shape& out, int filter_rows,
                  int filter_columns);

// The operators' arithmetic. Sizes have been checked; `out` has its shape and its room.
void Convolve(const Step& step, const Tensor& in, const Tensor& filter, const float* bias,
              Tensor& out);
void DepthwiseConv(const Step& step, const Tensor& in, const Tensor& filter, const float* bias,
                   Tensor& out);
/// Each input pixel paints a block of `filter` size, side by side.
void TransposeConv(const Tensor& in, const Tensor& filter, const float* bias, Tensor& out);
void Pool(const Step& step, const Tensor& in, Tensor& out);
void ResizeBilinear(const Step& step, const Tensor& in, Tensor& out);
void Pad(const Tensor& in, const std::vector<std::int32_t>& by, Tensor& out);
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
