#include "fsm/mesh/gltf/gltf_document.h"

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "fsm/image/byte_order.h"
#include "fsm/mesh/mesh_limits.h"
#include "vm_protocol/runtime/base64.h"

namespace fsm {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNumbers = 4U << 20;  ///< per accessor: elements times numbers per element
constexpr std::size_t kMaxDepth = 64;          ///< nesting of the JSON

const json kNothing = json::object();

std::uint32_t Word(std::string_view bytes, std::size_t at) {
  return LittleEndian(BytesOf(bytes), at, 4);
}

struct Kind {
  std::size_t bytes;
  double scale;  // divisor of normalised values
  bool sign;
};

std::optional<Kind> KindOf(std::int64_t component) {
  switch (static_cast<GltfType>(component)) {
    case GltfType::kInt8:
      return Kind{1, 127, true};
    case GltfType::kUint8:
      return Kind{1, 255, false};
    case GltfType::kInt16:
      return Kind{2, 32767, true};
    case GltfType::kUint16:
      return Kind{2, 65535, false};
    case GltfType::kUint32:
      return Kind{4, 4294967295.0, false};
    case GltfType::kFloat:
      return Kind{4, 1, true};
    default:
      return std::nullopt;
  }
}

double Value(const std::uint8_t* at, std::int64_t component, const Kind& kind, bool normalised) {
  const std::uint32_t bits = LittleEndian(std::span(at, kind.bytes), 0, kind.bytes);
  if (component == static_cast<std::int64_t>(GltfType::kFloat)) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof(value));
    return std::isfinite(value) ? static_cast<double>(value) : 0;
  }
  double value = bits;
  if (kind.sign) {
    value = kind.bytes == 1 ? static_cast<std::int8_t>(bits) : static_cast<std::int16_t>(bits);
  }
  return normalised ? std::max(value / kind.scale, -1.0) : value;
}

int WidthOf(const std::string& type) {
  constexpr std::array<std::pair<const char*, int>, 5> kTypes{
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}}};
  for (const auto& [name, width] : kTypes) {
    if (type == name) return width;
  }
  return 0;
}

}  // namespace

std::int64_t JsonInteger(const json& object, const char* key, std::int64_t otherwise) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_number_integer() ? found->get<std::int64_t>()
                                                             : otherwise;
}
double JsonNumber(const json& object, const char* key, double otherwise) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}
std::string JsonText(const json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}
const json& JsonMember(const json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_structured() ? *found : kNothing;
}

std::vector<std::int64_t> JsonIntegers(const json& object, const char* key) {
  std::vector<std::int64_t> wholes;
  for (const json& element : JsonMember(object, key)) {
    if (element.is_number_integer()) wholes.push_back(element.get<std::int64_t>());
  }
  return wholes;
}
void JsonNumbers(const json& object, const char* key, std::span<float> out) {
  const json& list = JsonMember(object, key);
  for (std::size_t i = 0; list.is_array() && i < std::min(list.size(), out.size()); ++i) {
    if (list[i].is_number()) out[i] = list[i].get<float>();
  }
}

void RefuseFile(const std::string& what) { throw vm::Failure({vm::Errc::kBadValue, what}); }

GltfDocument::GltfDocument(std::string_view bytes, Beside beside) : beside_(std::move(beside)) {
  const Chunks chunks = bytes.starts_with("glTF") ? SplitBinary(bytes) : Chunks{bytes, {}};
  ParseJson(chunks.json);
  ReadBuffers(chunks.buffer);
}
GltfDocument::~GltfDocument() = default;

GltfDocument::Chunks GltfDocument::SplitBinary(std::string_view bytes) {
  constexpr std::size_t kJson = 0x4E4F534A, kBuffer = 0x004E4942;
  if (bytes.size() < 20 || Word(bytes, 4) != 2) {
    RefuseFile("byte 4: version 2 of binary glTF expected");
  }
  if (Word(bytes, 8) > bytes.size()) {
    RefuseFile("byte " + std::to_string(bytes.size()) + ": it ends here, but " +
               std::to_string(Word(bytes, 8)) + " bytes are announced");
  }
  Chunks chunks;
  std::size_t at = 12;
  for (int chunk = 0; at + 8 <= bytes.size(); ++chunk) {
    const std::size_t length = Word(bytes, at), kind = Word(bytes, at + 4);
    if (length > bytes.size() - at - 8) {
      RefuseFile("byte " + std::to_string(at) + ": a chunk of " + std::to_string(length) +
                 " bytes is cut off");
    }
    const std::string_view body = bytes.substr(at + 8, length);
    if (chunk == 0 && kind != kJson) RefuseFile("byte 16: a chunk of JSON expected");
    if (chunk == 0) chunks.json = body;
    if (chunk == 1 && kind == kBuffer) chunks.buffer = body;
    at += 8 + length + (4 - length % 4) % 4;
  }
  if (chunks.json.data() == nullptr) RefuseFile("byte 12: a chunk of JSON expected");
  return chunks;
}

void GltfDocument::ParseJson(std::string_view text) {
  // Deep nesting is limited because it costs stack, out of proportion to the length of the JSON.
  const auto shallow = [](int depth, json::parse_event_t, json&) {
    return depth <= static_cast<int>(kMaxDepth);
  };
  auto parsed = json::parse(text.begin(), text.end(), shallow, false);
  if (parsed.is_discarded() || !parsed.is_object() || !parsed.contains("asset")) {
    RefuseFile("no glTF: JSON with an \"asset\" expected");
  }
  json_ = std::make_unique<json>(std::move(parsed));
  if (!JsonText(JsonMember(root(), "asset"), "version").starts_with("2")) {
    RefuseFile("asset: version 2 expected");
  }
  for (const json& needed : JsonMember(root(), "extensionsRequired")) {
    for (const char* packed :
         {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      if (needed == json(packed)) {
        RefuseFile(std::string("extensionsRequired: ") + packed + ": " + kPackedMesh);
      }
    }
  }
}

void GltfDocument::ReadBuffers(std::optional<std::string_view> own) {
  std::size_t total = 0;
  for (std::size_t i = 0; i < Count("buffers"); ++i) {
    const json& buffer = At("buffers", static_cast<std::int64_t>(i));
    const std::string uri = JsonText(buffer, "uri"), place = "buffers[" + std::to_string(i) + "]";
    if (uri.empty() && i == 0 && own) {
      buffers_.emplace_back(*own);
    } else {
      buffers_.push_back(AtPlace(place, [&] { return Resolve(uri); }));
    }
    const std::size_t size = buffers_.back().size();
    if (total += size; total > kMaxMeshBytes) {
      throw vm::Failure({vm::Errc::kLimit,
                         "its buffers hold more than " + std::to_string(kMaxMeshBytes) + " bytes"});
    }
    if (JsonInteger(buffer, "byteLength", 0) > static_cast<std::int64_t>(size)) {
      RefuseFile(place + ": it is shorter than its byteLength");
    }
  }
}

const json& GltfDocument::At(const char* key, std::int64_t index) const {
  const json& list = JsonMember(*json_, key);
  if (!list.is_array() || index < 0 || static_cast<std::size_t>(index) >= list.size()) {
    return kNothing;
  }
  return list[static_cast<std::size_t>(index)];
}

std::size_t GltfDocument::Count(const char* key) const {
  const json& list = JsonMember(*json_, key);
  return list.is_array() ? list.size() : 0;
}

std::string GltfDocument::Resolve(const std::string& uri) const {
  if (uri.starts_with("data:")) {
    const auto comma = uri.find(";base64,");
    auto bytes = comma == std::string::npos
                     ? std::nullopt
                     : vm::DecodeBase64(std::string_view(uri).substr(comma + 8));
    if (!bytes) RefuseFile("its data URI is not base64");
    return std::move(*bytes);
  }
  auto bytes = uri.empty() || !beside_ ? std::nullopt : beside_(uri);
  if (!bytes) {
    RefuseFile("its file '" + uri.substr(0, 80) + "' cannot be read from beside it");
  }
  return std::move(*bytes);
}

GltfDocument::BufferView GltfDocument::ViewOf(std::int64_t index) const {
  const json& view = At("bufferViews", index);
  const std::int64_t buffer = JsonInteger(view, "buffer"),
                     offset = JsonInteger(view, "byteOffset", 0),
                     length = JsonInteger(view, "byteLength", -1),
                     stride = JsonInteger(view, "byteStride", 0);
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= buffers_.size() || offset < 0 ||
      length < 0 || stride < 0 || stride > 65536) {
    RefuseFile("bufferViews[" + std::to_string(index) + "]: it points nowhere");
  }
  const std::string& bytes = buffers_[static_cast<std::size_t>(buffer)];
  const auto size = static_cast<std::int64_t>(bytes.size());
  if (offset > size || length > size - offset) {
    RefuseFile("bufferViews[" + std::to_string(index) + "]: bytes " + std::to_string(offset) +
               " to " + std::to_string(offset) + " + " + std::to_string(length) +
               " are not in its buffer of " + std::to_string(size));
  }
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data()) + offset;
  return BufferView{{first, static_cast<std::size_t>(length)}, static_cast<std::size_t>(stride)};
}

void GltfDocument::ReadElements(const Elements& elements, const std::string& place,
                                const Take& take) const {
  const json& where = elements.where;
  const BufferView view = ViewOf(JsonInteger(where, "bufferView"));
  const std::int64_t offset = JsonInteger(where, "byteOffset", 0);
  const auto kind = KindOf(elements.component);
  const std::size_t tight = kind->bytes * elements.width;
  const std::size_t stride = view.stride == 0 ? tight : view.stride;
  if (offset < 0 ||
      (elements.count > 0 &&
       (stride < tight || static_cast<std::size_t>(offset) + stride * (elements.count - 1) + tight >
                              view.bytes.size()))) {
    RefuseFile(place + ": its elements are not in its bufferView");
  }
  for (std::size_t i = 0; i < elements.count; ++i) {
    const std::uint8_t* at = view.bytes.data() + static_cast<std::size_t>(offset) + i * stride;
    for (std::size_t k = 0; k < elements.width; ++k) {
      take(i, k, Value(at + k * kind->bytes, elements.component, *kind, elements.normalised));
    }
  }
}

std::vector<double> GltfDocument::Values(std::int64_t index, int width) const {
  const json& accessor = At("accessors", index);
  const std::string place = "accessors[" + std::to_string(index) + "]";
  const std::int64_t count = JsonInteger(accessor, "count", -1);
  const std::int64_t component = JsonInteger(accessor, "componentType");
  const int own_width = WidthOf(JsonText(accessor, "type"));
  if (count < 0 || !KindOf(component) || own_width == 0 || own_width != width) {
    RefuseFile(place + ": " + std::to_string(width) + " numbers of a known kind expected");
  }
  const auto numbers = static_cast<std::size_t>(width);
  // An accessor without a bufferView is all zeros, so a small file can declare any count.
  if (static_cast<std::size_t>(count) > kMaxNumbers / numbers) {
    throw vm::Failure(
        {vm::Errc::kLimit, place + ": more than " + std::to_string(kMaxNumbers) + " numbers"});
  }
  std::vector<double> out(static_cast<std::size_t>(count) * numbers, 0.0);
  const Elements own{accessor, component, static_cast<std::size_t>(count), numbers,
                     accessor.value("normalized", json(false)) == json(true)};
  if (accessor.contains("bufferView")) {
    const auto take = [&](std::size_t i, std::size_t k, double v) { out[i * numbers + k] = v; };
    ReadElements(own, place, take);
  }
  FillSparse(own, place, out);
  return out;
}

void GltfDocument::FillSparse(const Elements& own, const std::string& place,
                              std::vector<double>& out) const {
  const json& sparse = JsonMember(own.where, "sparse");
  if (sparse.empty()) return;
  const std::int64_t changed = JsonInteger(sparse, "count", -1);
  const json& indices = JsonMember(sparse, "indices");
  const std::int64_t index_type = JsonInteger(indices, "componentType");
  if (changed < 0 || static_cast<std::size_t>(changed) > own.count || !KindOf(index_type)) {
    RefuseFile(place + ": sparse: a damaged list");
  }
  std::vector<std::size_t> vertex(static_cast<std::size_t>(changed));
  bool inside = true;
  ReadElements({indices, index_type, vertex.size(), 1, false}, place,
               [&](std::size_t i, std::size_t, double v) {
                 inside = inside && v >= 0 && v < static_cast<double>(own.count);
                 vertex[i] = inside ? static_cast<std::size_t>(v) : 0;
               });
  if (!inside) RefuseFile(place + ": sparse: an index beyond its elements");
  ReadElements(
      {JsonMember(sparse, "values"), own.component, vertex.size(), own.width, own.normalised},
      place, [&](std::size_t i, std::size_t k, double v) { out[vertex[i] * own.width + k] = v; });
}

std::vector<float> GltfDocument::Numbers(std::int64_t accessor, int width) const {
  const auto read = Values(accessor, width);
  return {read.begin(), read.end()};
}

std::vector<std::uint32_t> GltfDocument::Indices(std::int64_t accessor) const {
  const auto read = Values(accessor, 1);
  std::vector<std::uint32_t> out;
  out.reserve(read.size());
  constexpr std::uint32_t kNone = 0xffffffff;
  for (const double v : read)
    out.push_back(v >= 0 && v < kNone ? static_cast<std::uint32_t>(v) : kNone);
  return out;
}

std::string GltfDocument::ImageBytes(std::int64_t index) const {
  const json& image = At("images", index);
  if (image.contains("bufferView")) {
    const BufferView view = ViewOf(JsonInteger(image, "bufferView"));
    return {view.bytes.begin(), view.bytes.end()};
  }
  return AtPlace("images[" + std::to_string(index) + "]",
                 [&] { return Resolve(JsonText(image, "uri")); });
}

}  // namespace fsm
