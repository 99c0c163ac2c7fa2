#include "face_fit/net/network.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

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

/// Whether an operator's inputs, weights and output fit together. What does not throws BadModel.
class StepChecker {
 public:
  StepChecker(const Model& model, const Step& step)
      : model_(model), step_(step), in_(Of(step.inputs[0])), out_(Of(step.output).shape) {}

  void Check() const {
    Require(in_.counts.empty(), "an operator works on whole numbers");
    Require(in_.shape.size[0] == 1 || step_.op == Op::kDequantize,
            "more than one picture at a time");
    switch (step_.op) {
      case Op::kConv:
      case Op::kDepthwiseConv:
      case Op::kTransposeConv:
        return CheckConvolution();
      case Op::kMaxPool:
      case Op::kAveragePool:
        Require(out_.channels() == in_.shape.channels(), "pooling changes the channels");
        return CheckWindow(step_.filter_rows, step_.filter_columns);
      case Op::kAdd:
      case Op::kMul:
      case Op::kPrelu:
        return CheckOperands();
      case Op::kConcatenation:
        return CheckConcatenation();
      case Op::kPad:
        return CheckPadding();
      case Op::kStridedSlice:
        return CheckSlice();
      case Op::kLandmarksToMatrix:
        return CheckCrop();
      case Op::kTransformTensor:
        CheckMatrix(Numbers(1));
        return Require(out_.channels() == in_.shape.channels() && out_.size[0] == 1,
                       "a part of a picture changes the channels");
      case Op::kTransformLandmarks:
        CheckMatrix(Numbers(1));
        return Require(out_ == in_.shape && (out_.channels() == 2 || out_.channels() == 3),
                       "points that are neither of a plane nor of space");
      case Op::kResizeBilinear:
        return Require(out_.channels() == in_.shape.channels(), "resizing changes the channels");
      case Op::kDequantize:
      case Op::kHardSwish:
      case Op::kLogistic:
      case Op::kRelu:
      case Op::kReshape:
        return Require(in_.shape.count() == out_.count(), "an operator changes the size");
    }
  }

 private:
  const Tensor& Of(int i) const { return model_.tensors[static_cast<std::size_t>(i)]; }
  const Tensor& Argument(std::size_t i) const {
    Require(i < step_.inputs.size() && step_.inputs[i] >= 0, "an operator lacks an input");
    return Of(step_.inputs[i]);
  }
  const Shape& Numbers(std::size_t i) const {
    Require(Argument(i).counts.empty(), "an operator works on whole numbers");
    return Argument(i).shape;
  }

  void CheckConvolution() const {
    const Shape& filter = Numbers(1);
    const bool each = step_.op == Op::kDepthwiseConv;
    Require(filter.channels() == in_.shape.channels() &&
                filter.size[0] == (each ? 1 : out_.channels()) &&
                (!each || out_.channels() == in_.shape.channels()),
            "a filter does not match its input");
    if (step_.op == Op::kTransposeConv) {
      Require(out_.rows() == in_.shape.rows() * filter.rows() &&
                  out_.columns() == in_.shape.columns() * filter.columns(),
              "an unfolding convolution of overlapping blocks");
    } else {
      CheckWindow(filter.rows(), filter.columns());
    }
    if (step_.inputs.size() < 3 || step_.inputs[2] < 0) return;
    Require(Numbers(2).count() == static_cast<std::size_t>(out_.channels()),
            "a bias of another size than the channels");
  }

  void CheckWindow(int rows, int columns) const {
    const Shape& in = in_.shape;
    Require(step_.same_padding || (rows <= in.rows() && columns <= in.columns()),
            "a filter larger than its input");
    Require(out_.rows() == SizeAfter(step_, in.rows(), step_.stride_rows, rows) &&
                out_.columns() == SizeAfter(step_, in.columns(), step_.stride_columns, columns),
            "a convolution's output has another size");
  }

  void CheckOperands() const {
    const std::size_t n = Numbers(1).count();
    const bool fits =
        Numbers(1) == in_.shape || n == 1 || n == static_cast<std::size_t>(in_.shape.channels());
    Require(out_ == in_.shape && fits, "operands of different sizes");
  }

  // Along the second axis of three, which is the third of four: whole blocks after each other.
  void CheckConcatenation() const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < step_.inputs.size(); ++i) {
      Require(Numbers(i).rows() == 1 && Numbers(i).channels() == out_.channels(),
              "a concatenation of another kind");
      sum += Numbers(i).count();
    }
    Require(step_.axis == 1 && out_.rows() == 1 && sum == out_.count(),
            "a concatenation of another kind");
  }

  void CheckPadding() const {
    const auto& by = Argument(1).counts;
    Require(by.size() == 8, "a padding of other than four axes");
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const std::int64_t before = by[2 * axis], after = by[2 * axis + 1];
      Require(before >= 0 && after >= 0 && in_.shape.size[axis] + before + after == out_.size[axis],
              "a padding of another size");
    }
  }

  void CheckSlice() const {
    const auto& begin = Argument(1).counts;
    const auto& end = Argument(2).counts;
    const auto& by = Argument(3).counts;
    Require(begin.size() == 4 && end.size() == 4 && by.size() == 4,
            "a slice of other than four axes");
    Require(step_.begin_mask == 0, "a slice whose begin is left open");
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const std::int64_t size = in_.shape.size[axis];
      const std::int64_t last = (step_.end_mask >> axis & 1) != 0 ? size : end[axis];
      Require(begin[axis] >= 0 && by[axis] > 0 && begin[axis] < last && last <= size,
              "a slice beyond its input");
      Require(out_.size[axis] == (last - begin[axis] + by[axis] - 1) / by[axis],
              "a slice of another size");
    }
  }

  void CheckCrop() const {
    CheckMatrix(out_);
    const std::size_t points = in_.shape.count() / 3;
    Require(in_.shape.channels() == 3 && step_.crop.left < points && step_.crop.right < points &&
                !step_.crop.points.empty() &&
                std::ranges::all_of(step_.crop.points, [=](std::size_t i) { return i < points; }),
            "a crop of points that are not there");
  }

  static void CheckMatrix(const Shape& shape) {
    Require(shape.count() == 16 && shape.columns() == 4 && shape.channels() == 4,
            "a matrix of other than four by four");
  }

  const Model& model_;
  const Step& step_;
  const Tensor& in_;
  const Shape& out_;
};

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
    StepChecker(model_, step).Check();
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

void Network::Run(std::span<const float> input) {
  Tensor& first = Of(model_.inputs[0]);
  assert(input.size() == first.values.size());
  std::ranges::copy(input, first.values.begin());
  for (const Step& step : model_.steps) {
    if (step.op == Op::kDequantize && Of(step.inputs[0]).constant) continue;
    Compute(step);
    Activate(step.activation, Of(step.output).values);
  }
}

void Network::Compute(const Step& step) {
  const Tensor& in = Of(step.inputs[0]);
  Tensor& out = Of(step.output);
  const auto second = [&]() -> const Tensor& { return Of(step.inputs[1]); };
  const float* bias =
      step.inputs.size() > 2 && step.inputs[2] >= 0 ? Of(step.inputs[2]).values.data() : nullptr;
  const auto each = [&](auto f) { std::ranges::transform(in.values, out.values.begin(), f); };
  switch (step.op) {
    case Op::kConv:
      return Convolve(step, in, second(), bias, out);
    case Op::kDepthwiseConv:
      return DepthwiseConv(step, in, second(), bias, out);
    case Op::kTransposeConv:
      return TransposeConv(in, second(), bias, out);
    case Op::kMaxPool:
    case Op::kAveragePool:
      return Pool(step, in, out);
    case Op::kAdd:
      return Combine(in, second(), out, [](float a, float b) { return a + b; });
    case Op::kMul:
      return Combine(in, second(), out, [](float a, float b) { return a * b; });
    case Op::kPrelu:
      return Combine(in, second(), out, [](float a, float b) { return a >= 0 ? a : a * b; });
    case Op::kConcatenation:
      return Concatenate(step, out);
    case Op::kPad:
      return Pad(in, second().counts, out);
    case Op::kStridedSlice:
      return StridedSlice(in, second().counts, Of(step.inputs[3]).counts, out);
    case Op::kLandmarksToMatrix:
      return LandmarksToMatrix(step.crop, in, out);
    case Op::kTransformTensor:
      return TransformTensor(in, second(), out);
    case Op::kTransformLandmarks:
      return TransformLandmarks(in, second(), out);
    case Op::kResizeBilinear:
      return ResizeBilinear(step, in, out);
    case Op::kDequantize:
    case Op::kReshape:
      return each(std::identity());
    case Op::kHardSwish:
      return each([](float x) { return x * std::clamp(x + 3, 0.0F, 6.0F) / 6; });
    case Op::kLogistic:
      return each([](float x) { return 1 / (1 + std::exp(-x)); });
    case Op::kRelu:
      return each([](float x) { return std::max(x, 0.0F); });
  }
}

void Network::Concatenate(const Step& step, Tensor& out) {
  auto to = out.values.begin();
  for (const int i : step.inputs) to = std::ranges::copy(Of(i).values, to).out;
}

}  // namespace facefit
