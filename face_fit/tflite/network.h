#pragma once

#include <span>
#include <variant>

#include "face_fit/tflite/model.h"

namespace facefit::tflite {

/// Runs a model. Thread: one at a time, since runs share the tensors they work in.
class Network {
 public:
  /// More multiplications than any of the networks needs, by some margin.
  static constexpr double kMaxWork = 4e9;

  /// Throws BadModel if shapes do not match, if an operator is used in an unknown way, or if a run
  /// takes more than about `most_work` multiplications: every network that was constructed can run.
  explicit Network(Model model, double most_work = kMaxWork);

  const Shape& input_shape() const { return TensorAt(model_.inputs[0]).shape; }
  std::size_t outputs() const { return model_.outputs.size(); }
  /// Runs the model. REQUIRES: `input` holds input_shape().count() numbers.
  void Run(std::span<const float> input);
  /// Returns an output of the last run.
  std::span<const float> output(std::size_t i) const { return TensorAt(model_.outputs[i]).values; }

 private:
  const Tensor& TensorAt(int i) const { return model_.tensors[static_cast<std::size_t>(i)]; }
  Tensor& TensorAt(int i) { return model_.tensors[static_cast<std::size_t>(i)]; }
  /// Returns whether a node only widens weights of half precision, which reading has done already.
  bool IsWidenedWeight(const Node& node) const {
    return std::holds_alternative<op::Dequantize>(node.op) && TensorAt(node.inputs[0]).constant;
  }

  Model model_;
};

}  // namespace facefit::tflite
