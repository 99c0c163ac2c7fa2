#include "face_fit/tflite/network.h"

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "face_fit/tflite/kernels.h"

namespace facefit::tflite {
namespace {

void Require(bool holds, const char* what) {
  if (!holds) throw BadModel(what);
}

int SizeAfter(const op::Window& window, int in, int stride, int filter) {
  return window.same_padding ? (in + stride - 1) / stride : (in - filter) / stride + 1;
}

/// Checks that an operator's inputs, weights and output fit together.
class NodeChecker {
 public:
  NodeChecker(const Model& model, const Node& node)
      : model_(model),
        node_(node),
        in_(TensorAt(node.inputs[0])),
        out_(TensorAt(node.output).shape) {}

  /// Throws BadModel if something does not fit.
  void Check() const {
    Require(in_.integers.empty(), "an operator works on whole numbers");
    Require((in_.shape.size[0] == 1 && out_.size[0] == 1) ||
                std::holds_alternative<op::Dequantize>(node_.op),
            "more than one picture at a time");
    std::visit([this](const auto& of) { CheckOf(of); }, node_.op);
  }

  /// Returns the approximate number of multiplications for each number of the output. REQUIRES: it
  /// has been checked.
  double WorkPerNumber() const {
    if (const auto* pooling = std::get_if<op::Pooling>(&node_.op)) {
      return std::min(pooling->rows, in_.shape.rows()) *
             std::min(pooling->columns, in_.shape.columns());
    }
    const bool filters = std::holds_alternative<op::Convolution>(node_.op) ||
                         std::holds_alternative<op::DepthwiseConvolution>(node_.op) ||
                         std::holds_alternative<op::TransposeConvolution>(node_.op);
    return filters ? static_cast<double>(ShapeOfFloats(1).count()) / out_.channels() : 1;
  }

 private:
  const Tensor& TensorAt(int i) const { return model_.tensors[static_cast<std::size_t>(i)]; }
  const Tensor& Argument(std::size_t i) const {
    Require(i < node_.inputs.size() && node_.inputs[i] >= 0, "an operator lacks an input");
    return TensorAt(node_.inputs[i]);
  }
  const Shape& ShapeOfFloats(std::size_t i) const {
    Require(Argument(i).integers.empty(), "an operator works on whole numbers");
    return Argument(i).shape;
  }

  void CheckOf(const op::Convolution& convolution) const {
    CheckWindow(convolution.window, ShapeOfFloats(1).rows(), ShapeOfFloats(1).columns());
    CheckFilter(out_.channels());
  }
  void CheckOf(const op::DepthwiseConvolution& convolution) const {
    CheckWindow(convolution.window, ShapeOfFloats(1).rows(), ShapeOfFloats(1).columns());
    Require(out_.channels() == in_.shape.channels(), "a filter does not match its input");
    CheckFilter(1);
  }
  void CheckOf(const op::TransposeConvolution&) const {
    const auto times = [](int a, int b) { return std::int64_t{a} * b; };
    Require(out_.rows() == times(in_.shape.rows(), ShapeOfFloats(1).rows()) &&
                out_.columns() == times(in_.shape.columns(), ShapeOfFloats(1).columns()),
            "an unfolding convolution of overlapping blocks");
    CheckFilter(out_.channels());
  }
  void CheckFilter(int count) const {
    const Shape& filter = ShapeOfFloats(1);
    Require(filter.channels() == in_.shape.channels() && filter.size[0] == count,
            "a filter does not match its input");
    Require(node_.inputs.size() < 3 || node_.inputs[2] < 0 ||
                ShapeOfFloats(2).count() == static_cast<std::size_t>(out_.channels()),
            "a bias of another size than the channels");
  }

  void CheckOf(const op::Pooling& pooling) const {
    Require(out_.channels() == in_.shape.channels(), "pooling changes the channels");
    CheckWindow(pooling.window, pooling.rows, pooling.columns);
  }

  void CheckWindow(const op::Window& window, int rows, int columns) const {
    const Shape& in = in_.shape;
    Require(window.same_padding || (rows <= in.rows() && columns <= in.columns()),
            "a filter larger than its input");
    Require(out_.rows() == SizeAfter(window, in.rows(), window.stride_rows, rows) &&
                out_.columns() == SizeAfter(window, in.columns(), window.stride_columns, columns),
            "a convolution's output has another size");
  }

  void CheckOf(const op::UnaryOperator&) const {
    Require(in_.shape.count() == out_.count(), "an operator changes the size");
  }

  void CheckOf(const op::BinaryOperator&) const {
    const std::size_t n = ShapeOfFloats(1).count();
    const bool fits = ShapeOfFloats(1) == in_.shape || n == 1 ||
                      n == static_cast<std::size_t>(in_.shape.channels());
    Require(out_ == in_.shape && fits, "operands of different sizes");
  }

  // Supported along the second axis of three, which is the third of four: whole blocks follow each
  // other.
  void CheckOf(const op::Concatenation& concatenation) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < node_.inputs.size(); ++i) {
      Require(ShapeOfFloats(i).rows() == 1 && ShapeOfFloats(i).channels() == out_.channels(),
              "a concatenation of another kind");
      sum += ShapeOfFloats(i).count();
    }
    Require(concatenation.axis == 1 && out_.rows() == 1 && sum == out_.count(),
            "a concatenation of another kind");
  }

  void CheckOf(const op::Pad&) const {
    const auto& by = Argument(1).integers;
    Require(by.size() == 8, "a padding of other than four axes");
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const std::int64_t before = by[2 * axis], after = by[2 * axis + 1];
      Require(before >= 0 && after >= 0 && in_.shape.size[axis] + before + after == out_.size[axis],
              "a padding of another size");
    }
  }

  void CheckOf(const op::StridedSlice& slice) const {
    const auto& begin = Argument(1).integers;
    const auto& end = Argument(2).integers;
    const auto& by = Argument(3).integers;
    Require(begin.size() == 4 && end.size() == 4 && by.size() == 4,
            "a slice of other than four axes");
    Require(slice.begin_mask == 0, "a slice whose begin is left open");
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const std::int64_t size = in_.shape.size[axis];
      const std::int64_t last = (slice.end_mask >> axis & 1) != 0 ? size : end[axis];
      Require(begin[axis] >= 0 && by[axis] > 0 && begin[axis] < last && last <= size,
              "a slice beyond its input");
      Require(out_.size[axis] == (last - begin[axis] + by[axis] - 1) / by[axis],
              "a slice of another size");
    }
  }

  void CheckOf(const op::ResizeBilinear&) const {
    Require(out_.channels() == in_.shape.channels(), "resizing changes the channels");
  }

  void CheckOf(const op::LandmarksToMatrix& options) const {
    CheckMatrix(out_);
    const std::size_t points = in_.shape.count() / 3;
    Require(in_.shape.channels() == 3 && options.left < points && options.right < points &&
                !options.points.empty() &&
                std::ranges::all_of(options.points, [=](std::size_t i) { return i < points; }),
            "a crop of points that are not there");
  }
  void CheckOf(const op::TransformTensor&) const {
    CheckMatrix(ShapeOfFloats(1));
    Require(out_.channels() == in_.shape.channels(), "a part of a picture changes the channels");
  }
  void CheckOf(const op::TransformLandmarks&) const {
    CheckMatrix(ShapeOfFloats(1));
    Require(out_ == in_.shape && (out_.channels() == 2 || out_.channels() == 3),
            "points that are neither of a plane nor of space");
  }

  static void CheckMatrix(const Shape& shape) {
    Require(shape.count() == 16 && shape.columns() == 4 && shape.channels() == 4,
            "a matrix of other than four by four");
  }

  const Model& model_;
  const Node& node_;
  const Tensor& in_;
  const Shape& out_;
};

}  // namespace

Network::Network(Model model, double most_work) : model_(std::move(model)) {
  std::vector<bool> known(model_.tensors.size());
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = model_.tensors[i].constant;
  Require(model_.inputs.size() == 1, "a network of other than one input");
  const auto input = static_cast<std::size_t>(model_.inputs[0]);
  Require(!known[input], "a network's input is a constant");
  known[input] = true;
  double work = 0;
  for (const Node& node : model_.nodes) {
    for (const int i : node.inputs) {
      Require(i < 0 || known[static_cast<std::size_t>(i)], "an operator comes before its input");
    }
    const NodeChecker checker(model_, node);
    checker.Check();
    const auto out = static_cast<std::size_t>(node.output);
    Require(!known[out], "two operators write one tensor");
    known[out] = true;
    work += checker.WorkPerNumber() * static_cast<double>(TensorAt(node.output).shape.count());
    Require(work < most_work, "the network is too large");
  }
  for (const int i : model_.outputs) {
    Require(known[static_cast<std::size_t>(i)], "nothing writes the network's output");
  }
  std::size_t total = 0;
  for (Tensor& tensor : model_.tensors) {
    if (tensor.constant) continue;
    total += tensor.shape.count();
    Require(total < 8 * Model::kMaxTensor, "the network is too large");
    tensor.values.resize(tensor.shape.count());
  }
  for (const Node& node : model_.nodes) {
    if (IsWidenedWeight(node)) TensorAt(node.output).values = TensorAt(node.inputs[0]).values;
  }
}

void Network::Run(std::span<const float> input) {
  Tensor& first = TensorAt(model_.inputs[0]);
  assert(input.size() == first.values.size());
  std::ranges::copy(input, first.values.begin());
  for (const Node& node : model_.nodes) {
    if (IsWidenedWeight(node)) continue;
    std::vector<const Tensor*> inputs;
    for (const int i : node.inputs) inputs.push_back(i < 0 ? nullptr : &TensorAt(i));
    Tensor& out = TensorAt(node.output);
    std::visit([&](const auto& of) { tflite::Run(of, inputs, out); }, node.op);
    Activate(node.activation, out.values);
  }
}

}  // namespace facefit::tflite
