#include "face_fit/net/model.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "face_fit/net/flex_buffer.h"

namespace facefit {
namespace {

// Numbers and places of fields are those of tensorflow/lite/schema/schema.fbs.
enum : int { kFloat32 = 0, kFloat16 = 1, kInt32 = 2 };
constexpr int kCustom = 32;
constexpr std::pair<const char*, Op> kCustomOps[] = {
    {"Convolution2DTransposeBias", Op::kTransposeConv},
    {"Landmarks2TransformMatrix", Op::kLandmarksToMatrix},
    {"TransformLandmarks", Op::kTransformLandmarks},
    {"TransformTensorBilinear", Op::kTransformTensor}};
constexpr std::pair<int, Op> kOps[] = {
    {0, Op::kAdd},        {1, Op::kAveragePool},   {2, Op::kConcatenation},
    {3, Op::kConv},       {4, Op::kDepthwiseConv}, {6, Op::kDequantize},
    {14, Op::kLogistic},  {17, Op::kMaxPool},      {18, Op::kMul},
    {19, Op::kRelu},      {22, Op::kReshape},      {23, Op::kResizeBilinear},
    {34, Op::kPad},       {45, Op::kStridedSlice}, {54, Op::kPrelu},
    {117, Op::kHardSwish}};

std::vector<std::int32_t> Numbers(const FlatTable& table, std::size_t field) {
  std::size_t count = 0;
  const Bytes bytes = table.Vector(field, 4, count);
  std::vector<std::int32_t> numbers(count);
  if (count > 0) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

float Half(std::uint16_t h) {
  const std::uint32_t sign = static_cast<std::uint32_t>(h & 0x8000U) << 16;
  const std::uint32_t exponent = (h >> 10) & 31U;
  const std::uint32_t fraction = h & 1023U;
  if (exponent == 0) {
    const float tiny = static_cast<float>(fraction) * 0x1p-24F;
    return sign ? -tiny : tiny;
  }
  if (exponent == 31) throw BadModel("a weight is not a number");
  return std::bit_cast<float>(sign | (exponent + 112) << 23 | fraction << 13);
}

Shape ReadShape(const FlatTable& table) {
  const auto numbers = Numbers(table, 0);
  if (numbers.size() > 4) throw BadModel("a tensor of more than four dimensions");
  Shape shape;
  std::size_t total = 1;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::int32_t n = numbers[i];
    if (n < 1 || static_cast<std::size_t>(n) > Model::kMaxTensor) {
      throw BadModel("a tensor of impossible size");
    }
    total *= static_cast<std::size_t>(n);
    if (total > Model::kMaxTensor) throw BadModel("a tensor is too large");
    shape.size[4 - numbers.size() + i] = n;
  }
  return shape;
}

Tensor ReadTensor(const FlatTable& model, const FlatTable& table) {
  Tensor tensor;
  tensor.shape = ReadShape(table);
  const int type = table.Scalar<std::int8_t>(1, 0);
  const auto buffer = table.Scalar<std::uint32_t>(2, 0);
  if (buffer == 0) return tensor;
  std::size_t bytes = 0;
  const Bytes data = model.TableAt(4, buffer).Vector(0, 1, bytes);
  if (bytes == 0) return tensor;
  const std::size_t count = tensor.shape.count();
  const auto expect = [&](std::size_t each) {
    if (bytes != count * each) throw BadModel("a tensor's data does not have its size");
  };
  tensor.constant = true;
  if (type == kFloat32) {
    expect(4);
    tensor.values.resize(count);
    std::memcpy(tensor.values.data(), data.data(), bytes);
  } else if (type == kFloat16) {
    expect(2);
    tensor.values.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      tensor.values[i] = Half(
          static_cast<std::uint16_t>(data[2 * i] | static_cast<unsigned>(data[2 * i + 1]) << 8));
    }
  } else if (type == kInt32) {
    expect(4);
    tensor.counts.resize(count);
    std::memcpy(tensor.counts.data(), data.data(), bytes);
  } else {
    throw BadModel("a tensor of type " + std::to_string(type) + ", which is not read here");
  }
  return tensor;
}

Op ReadOp(const FlatTable& code) {
  const int number = std::max<int>(code.Scalar<std::int8_t>(0, 0), code.Scalar<std::int32_t>(3, 0));
  if (number == kCustom) {
    const std::string name = code.Text(1);
    for (const auto& [known, op] : kCustomOps) {
      if (name == known) return op;
    }
    throw BadModel("the operator '" + name + "' is not known here");
  }
  for (const auto& [known, op] : kOps) {
    if (known == number) return op;
  }
  throw BadModel("the operator " + std::to_string(number) + " is not known here");
}

Activation ReadActivation(int number) {
  if (number == 0) return Activation::kNone;
  if (number == 1) return Activation::kRelu;
  if (number == 3) return Activation::kRelu6;
  throw BadModel("the activation " + std::to_string(number) + " is not known here");
}

void ReadOptions(const FlatTable& options, Step& step) {
  const auto number = [&](std::size_t field) {
    const int n = options.Scalar<std::int32_t>(field, 1);
    if (n < 1 || n > 4096) throw BadModel("a stride or filter of impossible size");
    return n;
  };
  const auto act = [&](std::size_t field) {
    step.activation = ReadActivation(options.Scalar<std::int8_t>(field, 0));
  };
  switch (step.op) {
    case Op::kConv:
    case Op::kDepthwiseConv:
    case Op::kMaxPool:
    case Op::kAveragePool: {
      step.same_padding = options.Scalar<std::int8_t>(0, 0) == 0;
      step.stride_columns = number(1);
      step.stride_rows = number(2);
      if (step.op == Op::kConv) {
        act(3);
        if (number(4) != 1 || number(5) != 1) throw BadModel("a dilated convolution");
      } else if (step.op == Op::kDepthwiseConv) {
        // 0 stands for "as the shapes say", which are compared later.
        if (options.Scalar<std::int32_t>(3, 0) > 1)
          throw BadModel("a depthwise convolution of several filters");
        act(4);
        if (number(5) != 1 || number(6) != 1) throw BadModel("a dilated convolution");
      } else {
        step.filter_columns = number(3);
        step.filter_rows = number(4);
        act(5);
      }
      break;
    }
    case Op::kAdd:
    case Op::kMul:
      act(0);
      break;
    case Op::kConcatenation:
      step.axis = options.Scalar<std::int32_t>(0, 0);
      act(1);
      break;
    case Op::kStridedSlice:
      step.begin_mask = options.Scalar<std::int32_t>(0, 0);
      step.end_mask = options.Scalar<std::int32_t>(1, 0);
      for (const std::size_t other : {2U, 3U, 4U}) {
        if (options.Scalar<std::int32_t>(other, 0) != 0)
          throw BadModel("a slice that changes axes");
      }
      break;
    case Op::kResizeBilinear:
      step.align_corners = options.Scalar<std::uint8_t>(2, 0) != 0;
      step.half_pixel_centres = options.Scalar<std::uint8_t>(3, 0) != 0;
      break;
    default:
      break;
  }
}

/// The options of MediaPipe's operators, by the names that its TensorFlow Lite operations read
/// (mediapipe/util/tflite/operations, version 2 of each).
void ReadCustomOptions(Bytes bytes, Step& step) {
  const auto within = [](std::int64_t n, std::int64_t most) {
    if (n < 0 || n > most) throw BadModel("an operator's option is out of range");
    return n;
  };
  if (step.op != Op::kLandmarksToMatrix) return;
  const FlexMap map = FlexMap::Root(bytes);
  const auto most = static_cast<std::int64_t>(Model::kMaxTensor);
  const auto point = [&](std::int64_t n) { return static_cast<std::size_t>(within(n, most)); };
  const auto size = [&](const char* key) { return static_cast<int>(within(map.Whole(key), 4096)); };
  CropOptions& crop = step.crop;
  for (const std::int64_t n : map.Wholes("subset_idxs")) crop.points.push_back(point(n));
  crop.left = point(map.Whole("left_rotation_idx"));
  crop.right = point(map.Whole("right_rotation_idx"));
  crop.angle = static_cast<float>(map.Number("target_rotation_radians"));
  crop.scale_x = static_cast<float>(map.Number("scale_x"));
  crop.scale_y = static_cast<float>(map.Number("scale_y"));
  crop.rows = size("output_height");
  crop.columns = size("output_width");
  if (crop.points.empty() || crop.rows < 1 || crop.columns < 1) {
    throw BadModel("a crop without points or without size");
  }
}

}  // namespace

Model Model::Read(Bytes file) {
  if (file.size() < 16 || std::memcmp(file.data() + 4, "TFL3", 4) != 0) {
    throw BadModel("not a TensorFlow Lite file");
  }
  const FlatTable root = FlatTable::Root(file);
  if (root.TableCount(2) != 1) throw BadModel("one graph expected");
  const FlatTable graph = root.TableAt(2, 0);

  Model model;
  std::size_t total = 0;
  for (std::size_t i = 0; i < graph.TableCount(0); ++i) {
    model.tensors.push_back(ReadTensor(root, graph.TableAt(0, i)));
    // Tensors may share a buffer, so their number alone does not bound what is copied.
    total += model.tensors.back().values.size() + model.tensors.back().counts.size();
    if (total > 4 * kMaxTensor) throw BadModel("the weights are too large");
  }
  const auto known = [&model](const std::vector<int>& list) {
    return std::ranges::all_of(
        list, [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < model.tensors.size(); });
  };
  model.inputs = Numbers(graph, 1);
  model.outputs = Numbers(graph, 2);
  if (model.inputs.empty() || model.outputs.empty() || !known(model.inputs) ||
      !known(model.outputs)) {
    throw BadModel("the graph names a tensor that is not there");
  }
  std::vector<Op> ops;
  for (std::size_t i = 0; i < root.TableCount(1); ++i) ops.push_back(ReadOp(root.TableAt(1, i)));
  for (std::size_t i = 0; i < graph.TableCount(3); ++i) {
    const FlatTable table = graph.TableAt(3, i);
    const auto code = table.Scalar<std::uint32_t>(0, 0);
    if (code >= ops.size()) throw BadModel("an operator that is not listed");
    Step step{.op = ops[code], .inputs = Numbers(table, 1), .output = -1};
    const auto outputs = Numbers(table, 2);
    if (outputs.size() != 1 || step.inputs.empty() || !known(outputs)) {
      throw BadModel("an operator without input, or with other than one output");
    }
    step.output = outputs[0];
    auto given = step.inputs;
    std::erase(given, -1);
    if (given.empty() || step.inputs[0] < 0 || !known(given)) {
      throw BadModel("an operator names a tensor that is not there");
    }
    if (table.Has(4)) ReadOptions(table.Table(4), step);
    std::size_t bytes = 0;
    ReadCustomOptions(table.Vector(5, 1, bytes), step);
    model.steps.push_back(std::move(step));
  }
  return model;
}

}  // namespace facefit
