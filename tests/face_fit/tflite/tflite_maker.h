#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace facefit::tflite::maker {

/// What a field of a FlatBuffer's table holds.
struct Field {
  enum class Kind { kAbsent, kNumber, kNumbers, kBytes, kTable, kTables };
  Kind kind = Kind::kAbsent;
  std::int32_t number = 0;            ///< also of types that have fewer bytes
  std::vector<std::int32_t> numbers;  ///< each four bytes
  std::string bytes;                  ///< a string, or a vector of bytes
  std::vector<std::vector<Field>> tables;
};
using Fields = std::vector<Field>;  ///< of a table, by number

inline Field Number(std::int32_t n) { return {Field::Kind::kNumber, n, {}, {}, {}}; }
inline Field List(std::vector<std::int32_t> numbers) {
  return {Field::Kind::kNumbers, 0, std::move(numbers), {}, {}};
}
inline Field Text(std::string bytes) { return {Field::Kind::kBytes, 0, {}, std::move(bytes), {}}; }
inline Field One(Fields table) { return {Field::Kind::kTable, 0, {}, {}, {std::move(table)}}; }
inline Field Many(std::vector<Fields> tables) {
  return {Field::Kind::kTables, 0, {}, {}, std::move(tables)};
}

/// Lays tables out as google/flatbuffers ("Internals") says: the list of a table's fields, the
/// table, then what it refers to.
class FlatFile {
 public:
  explicit FlatFile(const Fields& root) {
    Put(0);
    bytes_ += "TFL3";
    Refer(0, Table(root));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void Put(std::int32_t n, std::size_t size = 4) {
    bytes_.append(reinterpret_cast<const char*>(&n), size);
  }
  /// Offsets count from where they stand.
  void Refer(std::size_t from, std::size_t to) {
    const auto by = static_cast<std::uint32_t>(to - from);
    std::memcpy(&bytes_[from], &by, sizeof by);
  }
  std::size_t Table(const Fields& fields) {
    const auto size = static_cast<std::int32_t>(4 + 4 * fields.size());
    const std::size_t list = bytes_.size();
    Put(static_cast<std::int32_t>(4 + 2 * fields.size()), 2);
    Put(size, 2);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const bool absent = fields[i].kind == Field::Kind::kAbsent;
      Put(absent ? 0 : static_cast<std::int32_t>(4 + 4 * i), 2);
    }
    const std::size_t table = bytes_.size();
    Put(static_cast<std::int32_t>(table - list));
    for (const Field& field : fields) Put(field.number);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const std::size_t place = table + 4 + 4 * i;
      using enum Field::Kind;
      if (fields[i].kind == kTable) Refer(place, Table(fields[i].tables[0]));
      if (fields[i].kind == kNumbers || fields[i].kind == kBytes || fields[i].kind == kTables)
        Refer(place, Vector(fields[i]));
    }
    return table;
  }
  std::size_t Vector(const Field& field) {
    const std::size_t vector = bytes_.size();
    const std::size_t count = field.numbers.size() + field.bytes.size() + field.tables.size();
    Put(static_cast<std::int32_t>(count));
    for (const std::int32_t n : field.numbers) Put(n);
    bytes_ += field.bytes;
    const std::size_t first = bytes_.size();
    for (std::size_t i = 0; i < field.tables.size(); ++i) Put(0);
    for (std::size_t i = 0; i < field.tables.size(); ++i)
      Refer(first + 4 * i, Table(field.tables[i]));
    return vector;
  }

  std::string bytes_;
};

template <typename T>
std::string BytesOf(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

struct FileTensor {
  std::vector<std::int32_t> shape;
  int type = 0;           ///< 0: float of 32 bits, 1: of 16 bits, 2: whole numbers of 32 bits
  std::string data = {};  ///< of a constant
};
struct FileNode {
  int code;  ///< of the schema's BuiltinOperator
  std::vector<std::int32_t> inputs;
  std::int32_t output;
  Fields options = {};
  std::string custom = {};  ///< the name of an operator whose code is 32
  std::string custom_options = {};
};

/// A TensorFlow Lite file. Its input is tensor 0, its output that of the last node.
inline std::string FileOf(const std::vector<FileTensor>& tensors,
                          const std::vector<FileNode>& nodes) {
  std::vector<Fields> of_tensors, buffers(1), codes, of_nodes;
  for (const FileTensor& tensor : tensors) {
    const auto buffer = tensor.data.empty() ? 0 : static_cast<std::int32_t>(buffers.size());
    if (buffer != 0) buffers.push_back({Text(tensor.data)});
    of_tensors.push_back({List(tensor.shape), Number(tensor.type), Number(buffer)});
  }
  for (const FileNode& node : nodes) {
    const auto code = static_cast<std::int32_t>(codes.size());
    codes.push_back({Number(node.code), node.custom.empty() ? Field{} : Text(node.custom)});
    of_nodes.push_back({Number(code),
                        List(node.inputs),
                        List({node.output}),
                        {},
                        node.options.empty() ? Field{} : One(node.options),
                        node.custom_options.empty() ? Field{} : Text(node.custom_options)});
  }
  const Fields graph = {Many(std::move(of_tensors)), List({0}), List({nodes.back().output}),
                        Many(std::move(of_nodes))};
  return FlatFile({Number(3), Many(std::move(codes)), Many({graph}), {}, Many(std::move(buffers))})
      .bytes();
}

/// The options of Landmarks2TransformMatrix, a map of a FlexBuffer: a crop of 4 x 4 over the first
/// three points, level with the line from the first to the second.
inline std::string CropOptions() {
  struct Entry {
    const char* key;  // in ascending order
    std::int32_t value;
    std::uint8_t type;
  };
  constexpr std::uint8_t kWhole = 1 << 2 | 2, kReal = 3 << 2 | 2, kWholes = 11 << 2 | 2;
  const auto one = std::bit_cast<std::int32_t>(1.5F);
  const Entry entries[] = {{"left_rotation_idx", 0, kWhole}, {"output_height", 4, kWhole},
                           {"output_width", 4, kWhole},      {"right_rotation_idx", 1, kWhole},
                           {"scale_x", one, kReal},          {"scale_y", one, kReal},
                           {"subset_idxs", 0, kWholes},      {"target_rotation_radians", 0, kReal}};
  constexpr std::int32_t kEntries = 8;
  std::string bytes;
  std::vector<std::size_t> names;
  for (const Entry& entry : entries) {
    names.push_back(bytes.size());
    bytes.append(entry.key).push_back('\0');
  }
  const auto put = [&bytes](std::int32_t n) { bytes.append(reinterpret_cast<const char*>(&n), 4); };
  /// Offsets count backwards from where they stand.
  const auto refer = [&](std::size_t to) { put(static_cast<std::int32_t>(bytes.size() - to)); };
  put(3);
  const std::size_t points = bytes.size();
  for (const std::int32_t n : {0, 1, 2}) put(n);
  put(kEntries);
  const std::size_t keys = bytes.size();
  for (const std::size_t name : names) refer(name);
  refer(keys);
  put(4);  // bytes of an offset to a key
  put(kEntries);
  const std::size_t map = bytes.size();
  for (const Entry& entry : entries) {
    if (entry.type == kWholes) {
      refer(points);
    } else {
      put(entry.value);
    }
  }
  for (const Entry& entry : entries) bytes.push_back(static_cast<char>(entry.type));
  refer(map);
  bytes.push_back(static_cast<char>(9 << 2 | 2));  // a map of numbers of four bytes
  bytes.push_back(4);
  return bytes;
}

/// A small network in which every operator occurs that is read here. Input: 4 x 4 pixels of two
/// channels.
inline std::string EveryOperator() {
  std::vector<FileTensor> tensors = {{.shape = {1, 4, 4, 2}}};
  std::vector<FileNode> nodes;
  const auto add = [&](FileTensor tensor) {
    tensors.push_back(std::move(tensor));
    return static_cast<std::int32_t>(tensors.size() - 1);
  };
  const auto weights = [&](std::vector<std::int32_t> shape) {
    std::size_t count = 1;
    for (const std::int32_t n : shape) count *= static_cast<std::size_t>(n);
    return add({.shape = std::move(shape), .data = BytesOf(std::vector(count, 0.25F))});
  };
  const auto integers = [&](const std::vector<std::int32_t>& numbers) {
    return add({.shape = {static_cast<std::int32_t>(numbers.size())},
                .type = 2,
                .data = BytesOf(numbers)});
  };
  std::int32_t last = 0;
  const auto then = [&](int code, std::vector<std::int32_t> more, std::vector<std::int32_t> shape,
                        Fields options = {}, std::string custom = {}, std::string flex = {}) {
    more.insert(more.begin(), last);
    last = add({.shape = std::move(shape)});
    nodes.push_back({.code = code,
                     .inputs = std::move(more),
                     .output = last,
                     .options = std::move(options),
                     .custom = std::move(custom),
                     .custom_options = std::move(flex)});
  };
  const std::vector<std::int32_t> image = {1, 4, 4, 2};
  const Field same = Number(0), relu = Number(1), one = Number(1), two = Number(2);
  // A filter of half precision, read by the operator 6.
  const std::int32_t halves = add(
      {.shape = {2, 3, 3, 2}, .type = 1, .data = BytesOf(std::vector<std::uint16_t>(36, 0x3400))});
  last = halves;
  then(6, {}, {2, 3, 3, 2});
  const std::int32_t filter = last;
  last = 0;
  then(3, {filter, weights({2})}, image, {same, one, one, relu});
  then(4, {weights({1, 3, 3, 2})}, image, {same, one, one, Number(0), Number(3)});
  const std::int32_t early = last;
  then(54, {weights({1, 1, 2})}, image);
  then(0, {early}, image);
  then(18, {weights({2})}, image);
  then(17, {}, {1, 2, 2, 2}, {same, two, two, two, two});
  then(1, {}, {1, 2, 2, 2}, {same, one, one, two, two});
  then(23, {integers({4, 4})}, image, {{}, {}, Number(0), Number(1)});
  then(34, {integers({0, 0, 1, 0, 0, 1, 0, 0})}, {1, 5, 5, 2});
  then(45, {integers({0, 1, 0, 0}), integers({1, 5, 4, 2}), integers({1, 1, 1, 1})}, image);
  then(32, {weights({2, 2, 2, 2})}, {1, 8, 8, 2}, {}, "Convolution2DTransposeBias");
  const std::int32_t whole = last;
  last = weights({1, 4, 3});
  const std::int32_t points = last;
  then(32, {}, {1, 1, 4, 4}, {}, "Landmarks2TransformMatrix", CropOptions());
  const std::int32_t matrix = last;
  last = points;
  then(32, {matrix}, {1, 4, 3}, {}, "TransformLandmarks");
  last = whole;
  then(32, {matrix}, image, {}, "TransformTensorBilinear");
  then(22, {}, {1, 16, 2});
  then(2, {last}, {1, 32, 2}, {one});
  then(14, {}, {1, 32, 2});
  then(19, {}, {1, 32, 2});
  then(117, {}, {1, 32, 2});
  return FileOf(tensors, nodes);
}

}  // namespace facefit::tflite::maker
