#include "face_fit/net/network.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "face_fit/net/kernels.h"

namespace facefit {
namespace {

void Require(bool holds, const char* what) {
  if (!holds) throw BadModel(what);
}

int SizeAfter(const Step& step, int in, int stride, int filter) {
  return step.same_padding ? (in + stride - 1) / stride : (in - filter) / stride + 1;
}

/// More multiplications than any of the networks needs, by some margin.
constexpr double kMostWork = 4e9;

}  // namespace

Network::Network(Model model) : model_(std::move(model)) {
  std::vector<bool> known(model_.tensors.size());
  std::size_t total = 0;
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = model_.tensors[i].constant;
  for (const int i : model_.inputs) {
    Require(!known[static_cast<std::size_t>(i)], "a network's input is a constant");
    known[static_cast<std::size_t>(i)] = true;
  }
  double work = 0;
  for (const Step& step : model_.steps) {
    for (const int i : step.inputs) {
      Require(i < 0 || known[static_cast<std::size_t>(i)], "an operator comes before its input");
    }
    Check(step);
    const auto out = static_cast<std::size_t>(step.output);
    Require(!known[out], "two operators write one tensor");
    known[out] = true;
    double each = 1;
    if (step.op == Op::kConv || step.op == Op::kDepthwiseConv || step.op == Op::kTransposeConv) {
      each =
          static_cast<double>(Of(step.inputs[1]).shape.count()) / Of(step.output).shape.channels();
    } else if (step.op == Op::kMaxPool || step.op == Op::kAveragePool) {
      each = std::min(step.filter_rows, Of(step.inputs[0]).shape.rows()) *
             std::min(step.filter_columns, Of(step.inputs[0]).shape.columns());
    }
    work += each * static_cast<double>(Of(step.output).shape.count());
    Require(work < kMostWork, "the network is too large");
  }
  for (const int i : model_.outputs) {
    Require(known[static_cast<std::size_t>(i)], "nothing writes the network's output");
  }
  for (Tensor& tensor : model_.tensors) {
    if (tensor.constant) continue;
    total += tensor.shape.count();
    Require(total < 8 * Model::kMaxTensor, "the network is too large");
    tensor.values.resize(tensor.shape.count());
  }
  // Weights of half precision have become floats already when they were read.
  for (const Step& step : model_.steps) {
    if (step.op != Op::kDequantize || !Of(step.inputs[0]).constant) continue;
    Of(step.output).values = Of(step.inputs[0]).values;
  }
}

void Network::Check(const Step& step) const {
  const Tensor& in = Of(step.inputs[0]);
  const Shape& out = Of(step.output).shape;
  Require(in.counts.empty(), "an operator works on whole numbers");
  const auto argument = [&](std::size_t i) -> const Tensor& {
    Require(i < step.inputs.size() && step.inputs[i] >= 0, "an operator lacks an input");
    return Of(step.inputs[i]);
  };
  const auto numbers = [&](std::size_t i) -> const Tensor& {
    Require(argument(i).counts.empty(), "an operator works on whole numbers");
    return argument(i);
  };
  const auto bias = [&] {
    if (step.inputs.size() < 3 || step.inputs[2] < 0) return;
    Require(numbers(2).shape.count() == static_cast<std::size_t>(out.channels()),
            "a bias of another size than the channels");
  };
  const auto window = [&](int rows, int columns) {
    Require(step.same_padding || (rows <= in.shape.rows() && columns <= in.shape.columns()),
            "a filter larger than its input");
    Require(out.rows() == SizeAfter(step, in.shape.rows(), step.stride_rows, rows) &&
                out.columns() == SizeAfter(step, in.shape.columns(), step.stride_columns, columns),
            "a convolution's output has another size");
  };
  Require(in.shape.size[0] == 1 || step.op == Op::kDequantize, "more than one picture at a time");
  switch (step.op) {
    case Op::kConv: {
      const Shape& filter = numbers(1).shape;
      Require(filter.channels() == in.shape.channels() && filter.size[0] == out.channels(),
              "a filter does not match its input");
      window(filter.rows(), filter.columns());
      return bias();
    }
    case Op::kDepthwiseConv: {
      const Shape& filter = numbers(1).shape;
      Require(filter.size[0] == 1 && filter.channels() == in.shape.channels() &&
                  out.channels() == in.shape.channels(),
              "a filter does not match its input");
      window(filter.rows(), filter.columns());
      return bias();
    }
    case Op::kTransposeConv: {
      const Shape& filter = numbers(1).shape;
      Require(filter.channels() == in.shape.channels() && filter.size[0] == out.channels() &&
                  out.rows() == in.shape.rows() * filter.rows() &&
                  out.columns() == in.shape.columns() * filter.columns(),
              "an unfolding convolution of overlapping blocks");
      return bias();
    }
    case Op::kMaxPool:
    case Op::kAveragePool:
      Require(out.channels() == in.shape.channels(), "pooling changes the channels");
      return window(step.filter_rows, step.filter_columns);
    case Op::kAdd:
    case Op::kMul:
    case Op::kPrelu: {
      const std::size_t n = numbers(1).shape.count();
      const bool fits = numbers(1).shape == in.shape || n == 1 ||
                        n == static_cast<std::size_t>(in.shape.channels());
      Require(out == in.shape && fits, "operands of different sizes");
      return;
    }
    case Op::kConcatenation: {
      // Along the second axis of three, which is the third of four: whole blocks after each other.
      std::size_t sum = 0;
      for (std::size_t i = 0; i < step.inputs.size(); ++i) {
        Require(numbers(i).shape.rows() == 1 && numbers(i).shape.channels() == out.channels(),
                "a concatenation of another kind");
        sum += numbers(i).shape.count();
      }
      Require(step.axis == 1 && out.rows() == 1 && sum == out.count(),
              "a concatenation of another kind");
      return;
    }
    case Op::kPad: {
      const auto& by = argument(1).counts;
      Require(by.size() == 8, "a padding of other than four axes");
      for (std::size_t axis = 0; axis < 4; ++axis) {
        const std::int64_t before = by[2 * axis], after = by[2 * axis + 1];
        Require(before >= 0 && after >= 0 && in.shape.size[axis] + before + after == out.size[axis],
                "a padding of another size");
      }
      return;
    }
    case Op::kResizeBilinear:
      Require(out.channels() == in.shape.channels(), "resizing changes the channels");
      return;
    case Op::kDequantize:
    case Op::kHardSwish:
    case Op::kLogistic:
    case Op::kRelu:
    case Op::kReshape:
      Require(in.shape.count() == out.count(), "an operator changes the size");
      return;
  }
}

void Network::Run(std::span<const float> input) {
  Tensor& first = Of(model_.inputs[0]);
  assert(input.size() == first.values.size());
  std::ranges::copy(input, first.values.begin());
  for (const Step& step : model_.steps) Do(step);
}

void Network::Do(const Step& step) {
  const Tensor& in = Of(step.inputs[0]);
  Tensor& out = Of(step.output);
  const auto second = [&]() -> const Tensor& { return Of(step.inputs[1]); };
  const float* bias =
      step.inputs.size() > 2 && step.inputs[2] >= 0 ? Of(step.inputs[2]).values.data() : nullptr;
  const auto each = [&](auto f) { std::ranges::transform(in.values, out.values.begin(), f); };
  switch (step.op) {
    case Op::kConv:
      Convolve(step, in, second(), bias, out);
      break;
    case Op::kDepthwiseConv:
      DepthwiseConv(step, in, second(), bias, out);
      break;
    case Op::kTransposeConv:
      TransposeConv(in, second(), bias, out);
      break;
    case Op::kMaxPool:
    case Op::kAveragePool:
      Pool(step, in, out);
      break;
    case Op::kAdd:
      Combine(in, second(), out, [](float a, float b) { return a + b; });
      break;
    case Op::kMul:
      Combine(in, second(), out, [](float a, float b) { return a * b; });
      break;
    case Op::kPrelu:
      Combine(in, second(), out, [](float a, float b) { return a >= 0 ? a : a * b; });
      break;
    case Op::kConcatenation: {
      auto to = out.values.begin();
      for (const int i : step.inputs) to = std::ranges::copy(Of(i).values, to).out;
      break;
    }
    case Op::kPad:
      Pad(in, second().counts, out);
      break;
    case Op::kResizeBilinear:
      ResizeBilinear(step, in, out);
      break;
    case Op::kDequantize:
      if (in.constant) return;
      [[fallthrough]];
    case Op::kReshape:
      std::ranges::copy(in.values, out.values.begin());
      break;
    case Op::kHardSwish:
      each([](float x) { return x * std::clamp(x + 3, 0.0F, 6.0F) / 6; });
      break;
    case Op::kLogistic:
      each([](float x) { return 1 / (1 + std::exp(-x)); });
      break;
    case Op::kRelu:
      each([](float x) { return std::max(x, 0.0F); });
      break;
  }
  Activate(step.activation, out.values);
}

}  // namespace facefit
