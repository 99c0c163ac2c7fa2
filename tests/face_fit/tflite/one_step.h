#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "face_fit/tflite/network.h"

namespace facefit::tflite {

/// Tensors of a model that is made by hand.
inline Tensor Variable(Shape shape) {
  return {.shape = shape, .constant = false, .values = {}, .counts = {}};
}
inline Tensor Constant(Shape shape, std::vector<float> values) {
  return {.shape = shape, .constant = true, .values = std::move(values), .counts = {}};
}
inline Tensor Counts(std::vector<std::int32_t> counts) {
  const int n = static_cast<int>(counts.size());
  return {.shape = {{1, 1, 1, n}}, .constant = true, .values = {}, .counts = std::move(counts)};
}

/// A model of one step: its first input is the network's, then come constants.
inline Model OneStep(Operator op, Shape in, std::vector<Tensor> constants, Shape out) {
  Model model;
  model.steps = {Step{.op = std::move(op), .inputs = {0}, .output = 0}};
  model.tensors = {Variable(in)};
  for (Tensor& constant : constants) {
    model.steps[0].inputs.push_back(static_cast<int>(model.tensors.size()));
    model.tensors.push_back(std::move(constant));
  }
  model.steps[0].output = static_cast<int>(model.tensors.size());
  model.tensors.push_back(Variable(out));
  model.inputs = {0};
  model.outputs = {model.steps[0].output};
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
