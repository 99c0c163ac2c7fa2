#include "face_fit/tflite/model.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>

#include "face_fit/tflite/flex_buffer.h"

namespace facefit::tflite {
namespace {

// Numbers and places of fields are those of tensorflow/lite/schema/schema.fbs.
enum : int { kFloat32 = 0, kFloat16 = 1, kInt32 = 2 };
enum ModelField : std::size_t { kModelOperatorCodes = 1, kModelSubgraphs, kModelBuffers = 4 };
enum SubgraphField : std::size_t {
  kSubgraphTensors,
  kSubgraphInputs,
  kSubgraphOutputs,
  kSubgraphOperators
};
enum TensorField : std::size_t { kTensorShape, kTensorType, kTensorBuffer };
enum BufferField : std::size_t { kBufferData };
enum OperatorCodeField : std::size_t { kByteCode, kCustomCode, kBuiltinCode = 3 };
enum OperatorField : std::size_t {
  kOperatorCode,
  kOperatorInputs,
  kOperatorOutputs,
  kOperatorOptions = 4,
  kOperatorCustomOptions
};
/// The first options of convolutions and of pooling.
enum WindowField : std::size_t { kWindowPadding, kWindowStrideColumns, kWindowStrideRows };
enum ConvolutionField : std::size_t { kConvolutionActivation = 3, kConvolutionDilation };
enum DepthwiseField : std::size_t {
  kDepthwiseMultiplier = 3,
  kDepthwiseActivation,
  kDepthwiseDilation
};
enum PoolingField : std::size_t { kPoolingColumns = 3, kPoolingRows, kPoolingActivation };
enum ConcatenationField : std::size_t { kConcatenationAxis, kConcatenationActivation };
/// Options of addition and multiplication.
enum PairField : std::size_t { kPairActivation };
enum SliceField : std::size_t {
  kSliceBeginMask,
  kSliceEndMask,
  kSliceEllipsisMask,
  kSliceNewAxisMask,
  kSliceShrinkAxisMask
};
enum ResizeField : std::size_t { kResizeAlignCorners = 2, kResizeHalfPixelCentres };

std::vector<std::int32_t> Numbers(const FlatTable& table, std::size_t field) {
  const Bytes bytes = table.Vector(field, 4);
  std::vector<std::int32_t> numbers(bytes.size() / 4);
  if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

Shape ReadShape(const FlatTable& table) {
  const auto numbers = Numbers(table, kTensorShape);
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
  const int type = table.Scalar<std::int8_t>(kTensorType, 0);
  const auto buffer = table.Scalar<std::uint32_t>(kTensorBuffer, 0);
  if (buffer == 0) return tensor;
  const Bytes data = model.TableAt(kModelBuffers, buffer).Vector(kBufferData, 1);
  if (data.empty()) return tensor;
  const std::size_t count = tensor.shape.count();
  const auto expect = [&](std::size_t each) {
    if (data.size() != count * each) throw BadModel("a tensor's data does not have its size");
  };
  tensor.constant = true;
  if (type == kFloat32) {
    expect(4);
    tensor.values.resize(count);
    std::memcpy(tensor.values.data(), data.data(), data.size());
    if (!std::ranges::all_of(tensor.values, [](float v) { return std::isfinite(v); })) {
      throw BadModel("a weight is not a number");
    }
  } else if (type == kFloat16) {
    expect(2);
    tensor.values.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto bits =
          static_cast<std::uint16_t>(data[2 * i] | static_cast<unsigned>(data[2 * i + 1]) << 8);
      tensor.values[i] = static_cast<float>(std::bit_cast<Eigen::half>(bits));
      if (!std::isfinite(tensor.values[i])) throw BadModel("a weight is not a number");
    }
  } else if (type == kInt32) {
    expect(4);
    tensor.integers.resize(count);
    std::memcpy(tensor.integers.data(), data.data(), data.size());
  } else {
    throw BadModel("a tensor of type " + std::to_string(type) + ", which is not read here");
  }
  return tensor;
}

/// Reads the options of a node; missing ones have their defaults.
class Options {
 public:
  Options(std::optional<FlatTable> table, Bytes custom) : table_(table), custom_(custom) {}
  std::int32_t Number(std::size_t field) const { return Scalar<std::int32_t>(field, 0); }
  std::int8_t Small(std::size_t field) const { return Scalar<std::int8_t>(field, 0); }
  bool Flag(std::size_t field) const { return Small(field) != 0; }
  /// Returns a stride or size of a filter.
  int Size(std::size_t field) const {
    const int n = Scalar<std::int32_t>(field, 1);
    if (n < 1 || n > 4096) throw BadModel("a stride or filter of impossible size");
    return n;
  }
  Bytes custom() const { return custom_; }

 private:
  template <typename T>
  T Scalar(std::size_t field, T otherwise) const {
    return table_ ? table_->Scalar<T>(field, otherwise) : otherwise;
  }
  std::optional<FlatTable> table_;
  Bytes custom_;
};

op::Window ReadWindow(const Options& options) {
  return {.same_padding = options.Small(kWindowPadding) == 0,
          .stride_rows = options.Size(kWindowStrideRows),
          .stride_columns = options.Size(kWindowStrideColumns)};
}

/// Throws BadModel if a filter is dilated. `field`: of the first of two dilations.
void RefuseDilation(const Options& options, std::size_t field) {
  if (options.Size(field) != 1 || options.Size(field + 1) != 1) {
    throw BadModel("a dilated convolution");
  }
}

template <typename Op>
Operator ReadPlain(const Options&) {
  return Op{};
}

Operator ReadConvolution(const Options& options) {
  RefuseDilation(options, kConvolutionDilation);
  return op::Convolution{ReadWindow(options)};
}

Operator ReadDepthwiseConvolution(const Options& options) {
  // 0 means "as the shapes say", which are compared later.
  if (options.Number(kDepthwiseMultiplier) > 1)
    throw BadModel("a depthwise convolution of several filters");
  RefuseDilation(options, kDepthwiseDilation);
  return op::DepthwiseConvolution{ReadWindow(options)};
}

template <bool max>
Operator ReadPooling(const Options& options) {
  return op::Pooling{.max = max,
                     .window = ReadWindow(options),
                     .rows = options.Size(kPoolingRows),
                     .columns = options.Size(kPoolingColumns)};
}

Operator ReadConcatenation(const Options& options) {
  return op::Concatenation{.axis = options.Number(kConcatenationAxis)};
}

Operator ReadStridedSlice(const Options& options) {
  for (const std::size_t other : {kSliceEllipsisMask, kSliceNewAxisMask, kSliceShrinkAxisMask}) {
    if (options.Number(other) != 0) throw BadModel("a slice that changes axes");
  }
  return op::StridedSlice{.begin_mask = options.Number(kSliceBeginMask),
                          .end_mask = options.Number(kSliceEndMask)};
}

Operator ReadResizeBilinear(const Options& options) {
  return op::ResizeBilinear{.align_corners = options.Flag(kResizeAlignCorners),
                            .half_pixel_centres = options.Flag(kResizeHalfPixelCentres)};
}

/// Reads options by the names of MediaPipe's TensorFlow Lite operation
/// (mediapipe/util/tflite/operations, version 2).
Operator ReadLandmarksToMatrix(const Options& options) {
  const auto within = [](std::int64_t n, std::int64_t most) {
    if (n < 0 || n > most) throw BadModel("an operator's option is out of range");
    return n;
  };
  const FlexMap map = FlexMap::Root(options.custom());
  const auto most = static_cast<std::int64_t>(Model::kMaxTensor);
  const auto point = [&](std::int64_t n) { return static_cast<std::size_t>(within(n, most)); };
  const auto size = [&](const char* key) {
    return static_cast<int>(within(map.Integer(key), 4096));
  };
  op::LandmarksToMatrix read;
  for (const std::int64_t n : map.Integers("subset_idxs")) read.points.push_back(point(n));
  read.left = point(map.Integer("left_rotation_idx"));
  read.right = point(map.Integer("right_rotation_idx"));
  read.angle_rad = static_cast<float>(map.Number("target_rotation_radians"));
  read.scale_x = static_cast<float>(map.Number("scale_x"));
  read.scale_y = static_cast<float>(map.Number("scale_y"));
  read.rows = size("output_height");
  read.columns = size("output_width");
  if (read.rows < 1 || read.columns < 1) throw BadModel("a crop without size");
  return read;
}

/// The identity of an operator in a file, and the function that reads its options.
struct Reader {
  int number;        ///< BuiltinOperator of the schema
  const char* name;  ///< its name there; of a custom operator the name that files give
  int activation;    ///< which field of the options names it; -1: there is none
  Operator (*read)(const Options&);
};
constexpr int kCustom = 32;
constexpr Reader kReaders[] = {
    {0, "ADD", kPairActivation, ReadPlain<op::Add>},
    {1, "AVERAGE_POOL_2D", kPoolingActivation, ReadPooling<false>},
    {2, "CONCATENATION", kConcatenationActivation, ReadConcatenation},
    {3, "CONV_2D", kConvolutionActivation, ReadConvolution},
    {4, "DEPTHWISE_CONV_2D", kDepthwiseActivation, ReadDepthwiseConvolution},
    {6, "DEQUANTIZE", -1, ReadPlain<op::Dequantize>},
    {14, "LOGISTIC", -1, ReadPlain<op::Logistic>},
    {17, "MAX_POOL_2D", kPoolingActivation, ReadPooling<true>},
    {18, "MUL", kPairActivation, ReadPlain<op::Multiply>},
    {19, "RELU", -1, ReadPlain<op::Relu>},
    {22, "RESHAPE", -1, ReadPlain<op::Reshape>},
    {23, "RESIZE_BILINEAR", -1, ReadResizeBilinear},
    {34, "PAD", -1, ReadPlain<op::Pad>},
    {45, "STRIDED_SLICE", -1, ReadStridedSlice},
    {54, "PRELU", -1, ReadPlain<op::Prelu>},
    {117, "HARD_SWISH", -1, ReadPlain<op::HardSwish>},
    {kCustom, "Convolution2DTransposeBias", -1, ReadPlain<op::TransposeConvolution>},
    {kCustom, "Landmarks2TransformMatrix", -1, ReadLandmarksToMatrix},
    {kCustom, "TransformLandmarks", -1, ReadPlain<op::TransformLandmarks>},
    {kCustom, "TransformTensorBilinear", -1, ReadPlain<op::TransformTensor>},
};

const Reader& ReaderOf(const FlatTable& code) {
  const int number = std::max<int>(code.Scalar<std::int8_t>(kByteCode, 0),
                                   code.Scalar<std::int32_t>(kBuiltinCode, 0));
  const std::string name = number == kCustom ? code.Text(kCustomCode) : "";
  const auto* found = std::ranges::find_if(kReaders, [&](const Reader& reader) {
    return reader.number == number && (number != kCustom || reader.name == name);
  });
  if (found != std::end(kReaders)) return *found;
  throw BadModel("the operator " + (number == kCustom ? "'" + name + "'" : std::to_string(number)) +
                 " is not known here");
}

Activation ReadActivation(int number) {
  if (number == 0) return Activation::kNone;
  if (number == 1) return Activation::kRelu;
  if (number == 3) return Activation::kRelu6;
  throw BadModel("the activation " + std::to_string(number) + " is not known here");
}

std::vector<Tensor> ReadTensors(const FlatTable& root, const FlatTable& graph) {
  std::vector<Tensor> tensors;
  std::size_t total = 0;
  for (std::size_t i = 0; i < graph.TableCount(kSubgraphTensors); ++i) {
    tensors.push_back(ReadTensor(root, graph.TableAt(kSubgraphTensors, i)));
    // Tensors may share a buffer, so their number alone does not bound what is copied.
    total += tensors.back().values.size() + tensors.back().integers.size();
    if (total > 4 * Model::kMaxTensor) throw BadModel("the weights are too large");
  }
  return tensors;
}

Node ReadNode(const FlatTable& table, const Reader& reader) {
  const Options options(
      table.Has(kOperatorOptions) ? std::optional(table.Table(kOperatorOptions)) : std::nullopt,
      table.Vector(kOperatorCustomOptions, 1));
  Node node{.op = reader.read(options), .inputs = Numbers(table, kOperatorInputs), .output = -1};
  if (reader.activation >= 0) {
    node.activation = ReadActivation(options.Small(static_cast<std::size_t>(reader.activation)));
  }
  const auto outputs = Numbers(table, kOperatorOutputs);
  if (outputs.size() != 1 || node.inputs.empty()) {
    throw BadModel("an operator without input, or with other than one output");
  }
  node.output = outputs[0];
  return node;
}

}  // namespace

Model Model::Read(Bytes file) {
  if (file.size() < 16 || std::memcmp(file.data() + 4, "TFL3", 4) != 0) {
    throw BadModel("not a TensorFlow Lite file");
  }
  const FlatTable root = FlatTable::Root(file);
  if (root.TableCount(kModelSubgraphs) != 1) throw BadModel("one graph expected");
  const FlatTable graph = root.TableAt(kModelSubgraphs, 0);
  Model model{.tensors = ReadTensors(root, graph),
              .nodes = {},
              .inputs = Numbers(graph, kSubgraphInputs),
              .outputs = Numbers(graph, kSubgraphOutputs)};
  const auto known = [&model](const std::vector<int>& list) {
    return !list.empty() && std::ranges::all_of(list, [&](int i) {
      return i >= 0 && static_cast<std::size_t>(i) < model.tensors.size();
    });
  };
  if (!known(model.inputs) || !known(model.outputs)) {
    throw BadModel("the graph names a tensor that is not there");
  }
  std::vector<Reader> readers;
  for (std::size_t i = 0; i < root.TableCount(kModelOperatorCodes); ++i) {
    readers.push_back(ReaderOf(root.TableAt(kModelOperatorCodes, i)));
  }
  for (std::size_t i = 0; i < graph.TableCount(kSubgraphOperators); ++i) {
    const FlatTable table = graph.TableAt(kSubgraphOperators, i);
    const auto code = table.Scalar<std::uint32_t>(kOperatorCode, 0);
    if (code >= readers.size()) throw BadModel("an operator that is not listed");
    const Node& node = model.nodes.emplace_back(ReadNode(table, readers[code]));
    auto used = node.inputs;
    std::erase(used, -1);
    used.push_back(node.output);
    if (node.inputs[0] < 0 || !known(used)) {
      throw BadModel("an operator names a tensor that is not there");
    }
  }
  return model;
}

}  // namespace facefit::tflite
