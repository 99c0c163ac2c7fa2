#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// Component types of glTF 2.0 accessors.
enum class GltfType {
  kInt8 = 5120,
  kUint8 = 5121,
  kInt16 = 5122,
  kUint16 = 5123,
  kUint32 = 5125,
  kFloat = 5126
};

/// A glTF 2.0 file taken apart: its JSON, and its buffers, every access to them checked. We read it
/// ourselves because tinygltf 2.7, the version to be had, trusts the offsets of a hostile file.
class GltfDocument {
 public:
  /// `beside`: the bytes of a file named by a relative URI; nothing for those not allowed or not
  /// there. Errors: kBadValue naming what is damaged; kLimit.
  static vm::Result<GltfDocument> Parse(
      const std::string& name, std::string_view bytes,
      const std::function<std::optional<std::string>(const std::string&)>& beside);
  GltfDocument(GltfDocument&&) noexcept;
  GltfDocument& operator=(GltfDocument&&) noexcept;
  ~GltfDocument();

  const nlohmann::json& root() const { return *json_; }
  /// Element `index` of the array `key` at the top; an empty object if there is none.
  const nlohmann::json& At(const char* key, std::int64_t index) const;
  std::size_t Count(const char* key) const;

  /// As Numbers, without loss for integers of 32 bits.
  vm::Result<std::vector<double>> Values(std::int64_t accessor, int width) const;
  /// Numbers of an accessor: `width` for each of its elements, normalised integers as 0..1, sparse
  /// ones filled in. Errors: kBadValue "NAME: accessors[I]: ...", kLimit.
  vm::Result<std::vector<float>> Numbers(std::int64_t accessor, int width) const;
  vm::Result<std::vector<std::uint32_t>> Indices(std::int64_t accessor) const;
  /// The bytes of images[index], wherever they are.
  vm::Result<std::string> ImageBytes(std::int64_t index) const;

  const std::string& name() const { return name_; }
  std::unexpected<vm::Error> Wrong(const std::string& text) const;

 private:
  struct BufferView {
    std::span<const std::uint8_t> bytes;
    std::size_t stride = 0;  // 0 = tight
  };
  /// The JSON of a binary file and the buffer it carries, if any.
  struct Chunks {
    std::string_view json;
    std::optional<std::string_view> buffer;
  };
  /// Elements of `width` numbers each, where `where` names a bufferView and a byteOffset.
  /// REQUIRES: a known component type.
  struct Elements {
    const nlohmann::json& where;
    std::int64_t component;
    std::size_t count, width;
    bool normalised;
  };
  using Take = std::function<void(std::size_t element, std::size_t k, double value)>;

  GltfDocument();
  vm::Result<Chunks> SplitBinary(std::string_view bytes) const;
  vm::Result<void> ParseJson(std::string_view text);
  vm::Result<void> ReadBuffers(std::optional<std::string_view> own);
  /// `place`: in the document, for messages.
  vm::Result<void> ReadElements(const Elements& elements, const std::string& place,
                                const Take& take) const;
  /// Puts the sparse numbers of an accessor in place.
  vm::Result<void> FillSparse(const Elements& own, const std::string& place,
                              std::vector<double>& out) const;
  vm::Result<BufferView> ViewOf(std::int64_t view) const;
  vm::Result<std::string> Resolve(const std::string& uri) const;

  std::string name_;
  std::unique_ptr<nlohmann::json> json_;
  std::vector<std::string> buffers_;
  std::function<std::optional<std::string>(const std::string&)> beside_;
};

/// What to say of geometry that is packed in a way not read here.
inline constexpr const char* kPackedMesh =
    "its geometry is compressed (Draco or meshopt), which is not read; export it uncompressed";

/// An integer member, or `otherwise` if it is missing or no integer.
std::int64_t JsonInteger(const nlohmann::json& object, const char* key,
                         std::int64_t otherwise = -1);
double JsonNumber(const nlohmann::json& object, const char* key, double otherwise);
std::string JsonText(const nlohmann::json& object, const char* key);
/// A member that is an array or object, else an empty one.
const nlohmann::json& JsonMember(const nlohmann::json& object, const char* key);
/// The integers of a list.
std::vector<std::int64_t> JsonIntegers(const nlohmann::json& object, const char* key);
/// Puts a list's numbers into `out`, place by place; what is no number leaves its place as it was.
void JsonNumbers(const nlohmann::json& object, const char* key, std::span<float> out);

}  // namespace fsm
