#pragma once

#include <algorithm>
#include <concepts>
#include <span>
#include <vector>

#include "face_fit/tflite/model.h"

namespace facefit::tflite {

/// The input tensors of a node, in the order of the file; nullptr = left out.
using Inputs = std::span<const Tensor* const>;

// The operators' arithmetic. Shapes are checked before; `out` has its shape and size.

// Inputs of convolutions: what is filtered, the filter, and a bias, which may be left out.
void Run(const op::Convolution& convolution, Inputs inputs, Tensor& out);
void Run(const op::DepthwiseConvolution& convolution, Inputs inputs, Tensor& out);
void Run(const op::TransposeConvolution& convolution, Inputs inputs, Tensor& out);

void Run(const op::Pooling& pooling, Inputs inputs, Tensor& out);
void Run(const op::ResizeBilinear& resize, Inputs inputs, Tensor& out);
void Run(const op::Concatenation& concatenation, Inputs inputs, Tensor& out);
/// The second input: how many zeros before and after each axis.
void Run(const op::Pad& pad, Inputs inputs, Tensor& out);
/// Takes elements of each axis, from the second input on, in steps of the fourth.
void Run(const op::StridedSlice& slice, Inputs inputs, Tensor& out);

// MediaPipe's operators for looking closer at parts of a face. A matrix is 4 x 4, row-major; its
// first two rows map (x, y, 0, 1) of the part to x and y of the whole.

/// Input: x, y, z of each point.
void Run(const op::LandmarksToMatrix& options, Inputs inputs, Tensor& matrix);
/// Crops a part, bilinearly. Pixel centres lie at .5; positions beyond the outermost centres are 0.
/// Inputs: the whole, a matrix.
void Run(const op::TransformTensor& transform, Inputs inputs, Tensor& out);
/// Maps points (x, y, or x, y, z with z unchanged) from the part to the whole. Inputs: the points,
/// a matrix.
void Run(const op::TransformLandmarks& transform, Inputs inputs, Tensor& out);

template <std::derived_from<op::UnaryOperator> Op>
void Run(const Op&, Inputs inputs, Tensor& out) {
  std::ranges::transform(inputs[0]->values, out.values.begin(),
                         [](float x) { return Op::Apply(x); });
}

template <std::derived_from<op::BinaryOperator> Op>
void Run(const Op&, Inputs inputs, Tensor& out) {
  const std::vector<float>&a = inputs[0]->values, &b = inputs[1]->values;
  for (std::size_t i = 0; i < a.size(); i += b.size()) {
    for (std::size_t k = 0; k < b.size(); ++k) out.values[i + k] = Op::Apply(a[i + k], b[k]);
  }
}

void Activate(Activation activation, std::vector<float>& values);

}  // namespace facefit::tflite
