#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

/// The operators of a network, each with its options: of those of TensorFlow Lite what the face
/// networks use. A new one needs a struct here, a row among the readers (model.cc), a check
/// (network.cc) and its arithmetic (kernels.h); the compiler asks for the last two.
namespace facefit::tflite::op {

/// Padding and strides of a filter or window.
struct Window {
  bool same_padding = false;
  int stride_rows = 1, stride_columns = 1;
};

/// An elementwise operator of one input, computed by `Apply`.
struct UnaryOperator {};
struct Dequantize : UnaryOperator {  ///< weights are read as what they stand for
  static float Apply(float x) { return x; }
};
struct Reshape : UnaryOperator {
  static float Apply(float x) { return x; }
};
struct HardSwish : UnaryOperator {
  static float Apply(float x) { return x * std::clamp(x + 3, 0.0F, 6.0F) / 6; }
};
struct Logistic : UnaryOperator {
  static float Apply(float x) { return 1 / (1 + std::exp(-x)); }
};
struct Relu : UnaryOperator {
  static float Apply(float x) { return std::max(x, 0.0F); }
};

/// An elementwise operator of two inputs, computed by `Apply`. The second input has the shape of
/// the first, or is one number for each channel, or one.
struct BinaryOperator {};
struct Add : BinaryOperator {
  static float Apply(float a, float b) { return a + b; }
};
struct Multiply : BinaryOperator {
  static float Apply(float a, float b) { return a * b; }
};
struct Prelu : BinaryOperator {
  static float Apply(float a, float b) { return a >= 0 ? a : a * b; }
};

struct Convolution {
  Window window;
};
struct DepthwiseConvolution {  ///< each channel by itself
  Window window;
};
struct TransposeConvolution {};  ///< each input pixel paints a block, side by side
struct Pooling {
  bool max = false;  ///< else the mean
  Window window;
  int rows = 1, columns = 1;
};
struct Concatenation {
  int axis = 0;
};
struct Pad {};
struct StridedSlice {
  int begin_mask = 0, end_mask = 0;  ///< bits of axes whose begin or end is that of the input
};
struct ResizeBilinear {
  bool align_corners = false, half_pixel_centres = false;
};

// MediaPipe's operators for looking closer at parts of a face.

/// Computes the matrix of an image of `columns` x `rows` over some points: rotated until the line
/// from point `left` to point `right` runs at `angle_rad`, its size that of the box round `points`
/// times the scales.
struct LandmarksToMatrix {
  std::vector<std::size_t> points;
  std::size_t left = 0, right = 0;
  float angle_rad = 0;
  float scale_x = 1, scale_y = 1;
  int rows = 1, columns = 1;
};
struct TransformTensor {};
struct TransformLandmarks {};

}  // namespace facefit::tflite::op

namespace facefit::tflite {

using Operator = std::variant<op::Add, op::Concatenation, op::Convolution, op::DepthwiseConvolution,
                              op::Dequantize, op::HardSwish, op::LandmarksToMatrix, op::Logistic,
                              op::Multiply, op::Pad, op::Pooling, op::Prelu, op::Relu, op::Reshape,
                              op::ResizeBilinear, op::StridedSlice, op::TransformLandmarks,
                              op::TransformTensor, op::TransposeConvolution>;

}  // namespace facefit::tflite
