#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "face_fit/tflite/flat_buffer.h"
#include "face_fit/tflite/operators.h"

namespace facefit::tflite {

/// Batch, rows, columns, channels; shorter shapes are filled with 1 from the left.
struct Shape {
  std::array<int, 4> size{1, 1, 1, 1};
  int rows() const { return size[1]; }
  int columns() const { return size[2]; }
  int channels() const { return size[3]; }
  std::size_t count() const {
    std::size_t n = 1;
    for (const int s : size) n *= static_cast<std::size_t>(s);
    return n;
  }
  bool operator==(const Shape&) const = default;
};

enum class Activation { kNone, kRelu, kRelu6 };

struct Node {
  Operator op;
  std::vector<int> inputs;  ///< tensors; -1 = left out
  int output;
  Activation activation = Activation::kNone;
};

struct Tensor {
  Shape shape;
  bool constant = false;
  std::vector<float> values;           ///< of a constant
  std::vector<std::int32_t> integers;  ///< of a constant: begins, ends, strides, paddings
};

/// A network read from a TensorFlow Lite file: floating point, weights of 16 or 32 bits, and only
/// the operators (Operator) that MediaPipe's face networks (also the one with attention) and its
/// segmentation of persons use.
///
/// The reader is our own because no library does this here: Debian 12 has no package of TensorFlow
/// Lite, and TensorFlow's own lacks four of the operators, which are MediaPipe's and come with its
/// build only. So few operators take less code than such a build would, depend on Eigen alone, and
/// are checked against files that were tampered with.
struct Model {
  std::vector<Tensor> tensors;
  std::vector<Node> nodes;
  std::vector<int> inputs, outputs;

  /// Throws BadModel with a sentence. Memory is bounded by a small multiple of the file's size and
  /// by kMaxTensor floats per tensor.
  static Model Read(Bytes file);
  static constexpr std::size_t kMaxTensor = 1U << 23;
};

}  // namespace facefit::tflite
