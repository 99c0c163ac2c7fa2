#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "face_fit/tflite/network.h"

namespace facefit::tflite {

/// Tensors of a model that is made by hand.
inline Tensor Variable(Shape shape) {
  return {.shape = shape, .constant = false, .values = {}, .integers = {}};
}
inline Tensor Constant(Shape shape, std::vector<float> values) {
  return {.shape = shape, .constant = true, .values = std::move(values), .integers = {}};
}
inline Tensor Integers(std::vector<std::int32_t> integers) {
  const int n = static_cast<int>(integers.size());
  return {.shape = {{1, 1, 1, n}}, .constant = true, .values = {}, .integers = std::move(integers)};
}

/// A model of one node: its first input is the network's, then come constants.
inline Model OneNode(Operator op, Shape in, std::vector<Tensor> constants, Shape out) {
  Model model;
  model.nodes = {Node{.op = std::move(op), .inputs = {0}, .output = 0}};
  model.tensors = {Variable(in)};
  for (Tensor& constant : constants) {
    model.nodes[0].inputs.push_back(static_cast<int>(model.tensors.size()));
    model.tensors.push_back(std::move(constant));
  }
  model.nodes[0].output = static_cast<int>(model.tensors.size());
  model.tensors.push_back(Variable(out));
  model.inputs = {0};
  model.outputs = {model.nodes[0].output};
  return model;
}

/// What a model makes of its input.
inline std::vector<float> OutputOf(Model model, const std::vector<float>& input) {
  Network network(std::move(model));
  network.Run(input);
  const auto output = network.output(0);
  return {output.begin(), output.end()};
}

}  // namespace facefit::tflite
