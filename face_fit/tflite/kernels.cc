#include "face_fit/tflite/kernels.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace facefit::tflite {
namespace {

std::size_t At(const Shape& s, int row, int column) {
  return (static_cast<std::size_t>(row) * static_cast<std::size_t>(s.columns()) +
          static_cast<std::size_t>(column)) *
         static_cast<std::size_t>(s.channels());
}

using RowMajorMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns the third input of a convolution; nullptr if it is left out.
const float* BiasOf(Inputs inputs) {
  return inputs.size() > 2 && inputs[2] ? inputs[2]->values.data() : nullptr;
}

void FillWithBias(Inputs inputs, Tensor& out) {
  const float* bias = BiasOf(inputs);
  const auto channels = static_cast<std::size_t>(out.shape.channels());
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = bias ? bias[i % channels] : 0;
  }
}

/// Rows and columns of zeros before the input.
struct Padding {
  int rows = 0, columns = 0;
};
Padding PaddingOf(const op::Window& window, const Shape& in, const Shape& out, int filter_rows,
                  int filter_columns) {
  if (!window.same_padding) return {};
  const auto before = [](int size_in, int size_out, int stride, int filter) {
    return std::max((size_out - 1) * stride + filter - size_in, 0) / 2;
  };
  return {before(in.rows(), out.rows(), window.stride_rows, filter_rows),
          before(in.columns(), out.columns(), window.stride_columns, filter_columns)};
}

/// Calls f(pixel, from, row, column) for pixels first to end - 1 of the output, counted row by row,
/// and each tap (row, column) of the filter that lies within the input; `from` is the index of the
/// first channel under the tap.
template <typename F>
void ForEachTap(const op::Window& window, const Shape& in, const Shape& out, const Shape& filter,
                Eigen::Index first, Eigen::Index end, F f) {
  const Padding pad = PaddingOf(window, in, out, filter.rows(), filter.columns());
  for (Eigen::Index pixel = first; pixel < end; ++pixel) {
    const int y = static_cast<int>(pixel / out.columns());
    const int x = static_cast<int>(pixel % out.columns());
    for (int r = 0; r < filter.rows(); ++r) {
      const int in_y = y * window.stride_rows + r - pad.rows;
      if (in_y < 0 || in_y >= in.rows()) continue;
      for (int c = 0; c < filter.columns(); ++c) {
        const int in_x = x * window.stride_columns + c - pad.columns;
        if (in_x < 0 || in_x >= in.columns()) continue;
        f(pixel, At(in, in_y, in_x), r, c);
      }
    }
  }
}

/// Writes the channels at (x, y), from the middle of the first pixel and clamped to the last, mixed
/// from the four pixels around.
void SampleBilinear(const Tensor& in, float x, float y, float* to) {
  x = std::clamp(x, 0.0F, static_cast<float>(in.shape.columns() - 1));
  y = std::clamp(y, 0.0F, static_cast<float>(in.shape.rows() - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, in.shape.columns() - 1);
  const int y1 = std::min(y0 + 1, in.shape.rows() - 1);
  const float right = x - static_cast<float>(x0), below = y - static_cast<float>(y0);
  const float* a = &in.values[At(in.shape, y0, x0)];
  const float* b = &in.values[At(in.shape, y0, x1)];
  const float* c = &in.values[At(in.shape, y1, x0)];
  const float* d = &in.values[At(in.shape, y1, x1)];
  for (int k = 0; k < in.shape.channels(); ++k) {
    const float upper = a[k] + (b[k] - a[k]) * right;
    const float lower = c[k] + (d[k] - c[k]) * right;
    to[k] = upper + (lower - upper) * below;
  }
}

}  // namespace

void Run(const op::Convolution& convolution, Inputs inputs, Tensor& out) {
  const Tensor &in = *inputs[0], &filter = *inputs[1];
  const op::Window& window = convolution.window;
  // Size of the patches of several pixels, side by side.
  constexpr Eigen::Index kMaxNumbers = 1 << 20;
  const Eigen::Index outs = out.shape.channels(), channels = in.shape.channels();
  const auto pixels = static_cast<Eigen::Index>(out.values.size()) / outs;
  const auto weights_per_output = static_cast<Eigen::Index>(filter.values.size()) / outs;
  const Eigen::Map<const RowMajorMatrix> weights(filter.values.data(), outs, weights_per_output);
  Eigen::Map<RowMajorMatrix> to(out.values.data(), pixels, outs);
  FillWithBias(inputs, out);
  if (weights_per_output == channels && window.stride_rows == 1 && window.stride_columns == 1) {
    to.noalias() +=
        Eigen::Map<const RowMajorMatrix>(in.values.data(), pixels, channels) * weights.transpose();
    return;
  }
  const Eigen::Index together =
      std::clamp<Eigen::Index>(kMaxNumbers / weights_per_output, 1, pixels);
  RowMajorMatrix patches(together,
                         weights_per_output);  // for each pixel the inputs under the filter
  for (Eigen::Index first = 0; first < pixels; first += together) {
    const Eigen::Index count = std::min(together, pixels - first);
    patches.setZero();
    ForEachTap(window, in.shape, out.shape, filter.shape, first, first + count,
               [&](Eigen::Index pixel, std::size_t from, int row, int column) {
                 const Eigen::Index tap = row * filter.shape.columns() + column;
                 std::copy_n(&in.values[from], channels, &patches(pixel - first, tap * channels));
               });
    to.middleRows(first, count).noalias() += patches.topRows(count) * weights.transpose();
  }
}

void Run(const op::DepthwiseConvolution& convolution, Inputs inputs, Tensor& out) {
  const Tensor &in = *inputs[0], &filter = *inputs[1];
  const auto channels = static_cast<std::size_t>(in.shape.channels());
  FillWithBias(inputs, out);
  ForEachTap(convolution.window, in.shape, out.shape, filter.shape, 0,
             static_cast<Eigen::Index>(out.values.size() / channels),
             [&](Eigen::Index pixel, std::size_t from, int row, int column) {
               float* sum = &out.values[static_cast<std::size_t>(pixel) * channels];
               const float* pixel_in = &in.values[from];
               const float* w = &filter.values[At(filter.shape, row, column)];
               for (std::size_t k = 0; k < channels; ++k) sum[k] += pixel_in[k] * w[k];
             });
}

void Run(const op::TransposeConvolution&, Inputs inputs, Tensor& out) {
  const Tensor &in = *inputs[0], &filter = *inputs[1];
  const float* bias = BiasOf(inputs);
  const auto channels = static_cast<std::size_t>(in.shape.channels());
  const int rows = filter.shape.rows();
  const int columns = filter.shape.columns();
  const int outs = out.shape.channels();
  const std::size_t block = filter.values.size() / static_cast<std::size_t>(outs);
  for (int y = 0; y < out.shape.rows(); ++y) {
    for (int x = 0; x < out.shape.columns(); ++x) {
      const float* from = &in.values[At(in.shape, y / rows, x / columns)];
      float* to = &out.values[At(out.shape, y, x)];
      for (int o = 0; o < outs; ++o) {
        const float* w =
            &filter.values[static_cast<std::size_t>(o) * block +
                           static_cast<std::size_t>(y % rows * columns + x % columns) * channels];
        float sum = bias ? bias[o] : 0;
        for (std::size_t k = 0; k < channels; ++k) sum += from[k] * w[k];
        to[o] = sum;
      }
    }
  }
}

void Run(const op::Pooling& pooling, Inputs inputs, Tensor& out) {
  const Tensor& in = *inputs[0];
  const auto channels = static_cast<std::size_t>(in.shape.channels());
  const bool max = pooling.max;
  const Padding pad = PaddingOf(pooling.window, in.shape, out.shape, pooling.rows, pooling.columns);
  for (int y = 0; y < out.shape.rows(); ++y) {
    for (int x = 0; x < out.shape.columns(); ++x) {
      float* to = &out.values[At(out.shape, y, x)];
      std::fill_n(to, channels, max ? -INFINITY : 0.0F);
      int count = 0;
      const int top = y * pooling.window.stride_rows - pad.rows;
      const int left = x * pooling.window.stride_columns - pad.columns;
      for (int r = std::max(top, 0); r < std::min(top + pooling.rows, in.shape.rows()); ++r) {
        for (int c = std::max(left, 0); c < std::min(left + pooling.columns, in.shape.columns());
             ++c) {
          const float* from = &in.values[At(in.shape, r, c)];
          ++count;
          for (std::size_t k = 0; k < channels; ++k) {
            to[k] = max ? std::max(to[k], from[k]) : to[k] + from[k];
          }
        }
      }
      if (max) continue;
      for (std::size_t k = 0; k < channels; ++k) to[k] /= static_cast<float>(std::max(count, 1));
    }
  }
}

void Run(const op::ResizeBilinear& resize, Inputs inputs, Tensor& out) {
  const Tensor& in = *inputs[0];
  const auto position = [&resize](int i, int size_in, int size_out) {
    const auto at = static_cast<float>(i);
    if (resize.align_corners && size_out > 1) {
      return at * static_cast<float>(size_in - 1) / static_cast<float>(size_out - 1);
    }
    const float scale = static_cast<float>(size_in) / static_cast<float>(size_out);
    return resize.half_pixel_centres ? (at + 0.5F) * scale - 0.5F : at * scale;
  };
  for (int y = 0; y < out.shape.rows(); ++y) {
    const float v = position(y, in.shape.rows(), out.shape.rows());
    for (int x = 0; x < out.shape.columns(); ++x) {
      SampleBilinear(in, position(x, in.shape.columns(), out.shape.columns()), v,
                     &out.values[At(out.shape, y, x)]);
    }
  }
}

void Run(const op::Concatenation&, Inputs inputs, Tensor& out) {
  auto to = out.values.begin();
  for (const Tensor* input : inputs) to = std::ranges::copy(input->values, to).out;
}

void Run(const op::Pad&, Inputs inputs, Tensor& out) {
  const Tensor& in = *inputs[0];
  const std::vector<std::int32_t>& zeros = inputs[1]->integers;  // before and after each axis
  std::ranges::fill(out.values, 0.0F);
  const auto channels = static_cast<std::size_t>(in.shape.channels());
  for (int y = 0; y < in.shape.rows(); ++y) {
    for (int x = 0; x < in.shape.columns(); ++x) {
      std::copy_n(&in.values[At(in.shape, y, x)], channels,
                  &out.values[At(out.shape, y + zeros[2], x + zeros[4]) +
                              static_cast<std::size_t>(zeros[6])]);
    }
  }
}

void Run(const op::StridedSlice&, Inputs inputs, Tensor& out) {
  const Tensor& in = *inputs[0];
  const std::vector<std::int32_t>&begin = inputs[1]->integers, &step = inputs[3]->integers;
  std::size_t to = 0;
  for (int y = 0; y < out.shape.rows(); ++y) {
    for (int x = 0; x < out.shape.columns(); ++x) {
      const std::size_t pixel = At(in.shape, begin[1] + y * step[1], begin[2] + x * step[2]);
      for (int k = 0; k < out.shape.channels(); ++k) {
        out.values[to++] = in.values[pixel + static_cast<std::size_t>(begin[3] + k * step[3])];
      }
    }
  }
}

void Run(const op::LandmarksToMatrix& options, Inputs inputs, Tensor& matrix) {
  const Tensor& points = *inputs[0];
  const auto x = [&points](std::size_t i) { return points.values[3 * i]; };
  const auto y = [&points](std::size_t i) { return points.values[3 * i + 1]; };
  const float angle_rad =
      std::atan2(y(options.right) - y(options.left), x(options.right) - x(options.left)) -
      options.angle_rad;
  // The part's axes in the whole: right = (c, s), down = (-s, c).
  const float c = std::cos(angle_rad), s = std::sin(angle_rad);
  float left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
  for (const std::size_t i : options.points) {
    const float along = c * x(i) + s * y(i), down = c * y(i) - s * x(i);
    left = std::min(left, along);
    right = std::max(right, along);
    top = std::min(top, down);
    bottom = std::max(bottom, down);
  }
  const float width = options.scale_x * (right - left), height = options.scale_y * (bottom - top);
  const float corner_along = (left + right - width) / 2, corner_down = (top + bottom - height) / 2;
  const float along = width / static_cast<float>(options.columns);
  const float down = height / static_cast<float>(options.rows);
  matrix.values = {c * along, -s * down, 0, c * corner_along - s * corner_down,  //
                   s * along, c * down,  0, s * corner_along + c * corner_down,  //
                   0,         0,         1, 0,                                   //
                   0,         0,         0, 1};
}

void Run(const op::TransformTensor&, Inputs inputs, Tensor& out) {
  const Tensor& in = *inputs[0];
  const auto channels = static_cast<std::size_t>(in.shape.channels());
  const float* m = inputs[1]->values.data();
  const auto last_x = static_cast<float>(in.shape.columns() - 1);
  const auto last_y = static_cast<float>(in.shape.rows() - 1);
  for (int row = 0; row < out.shape.rows(); ++row) {
    for (int column = 0; column < out.shape.columns(); ++column) {
      float* to = &out.values[At(out.shape, row, column)];
      const float u = static_cast<float>(column) + 0.5F, v = static_cast<float>(row) + 0.5F;
      const float x = m[0] * u + m[1] * v + m[3] - 0.5F, y = m[4] * u + m[5] * v + m[7] - 0.5F;
      if (!(x >= 0 && y >= 0 && x <= last_x && y <= last_y)) {
        std::fill_n(to, channels, 0.0F);
        continue;
      }
      SampleBilinear(in, x, y, to);
    }
  }
}

void Run(const op::TransformLandmarks&, Inputs inputs, Tensor& out) {
  const Tensor& in = *inputs[0];
  const auto each = static_cast<std::size_t>(in.shape.channels());
  const float* m = inputs[1]->values.data();
  out.values = in.values;
  for (std::size_t i = 0; i + each <= in.values.size(); i += each) {
    const float x = in.values[i], y = in.values[i + 1];
    out.values[i] = m[0] * x + m[1] * y + m[3];
    out.values[i + 1] = m[4] * x + m[5] * y + m[7];
  }
}

void Activate(Activation activation, std::vector<float>& values) {
  if (activation == Activation::kNone) return;
  const float most = activation == Activation::kRelu6 ? 6.0F : INFINITY;
  for (float& v : values) v = std::clamp(v, 0.0F, most);
}

}  // namespace facefit::tflite
