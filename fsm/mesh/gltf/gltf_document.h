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

#include "vm_protocol/core/or_throw.h"

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

/// Returns read(), and puts `place` before the text of an error that it throws.
template <typename Read>
auto AtPlace(const std::string& place, const Read& read) {
  try {
    return read();
  } catch (const vm::Failure& failure) {
    throw vm::Failure({failure.error.code, place + ": " + failure.error.text});
  }
}
/// Throws the error of a damaged file; `what` begins with the place in the file.
[[noreturn]] void RefuseFile(const std::string& what);

/// A parsed glTF 2.0 file: its JSON and its buffers, with every access checked. We do not use
/// tinygltf because 2.7, the version available, trusts the offsets in a hostile file.
/// Errors: vm::Failure with kBadValue or kLimit and a text that begins with the place in the file,
/// as "accessors[I]: ..."; whoever reads the file adds its name (AtPlace).
class GltfDocument {
 public:
  /// Returns the bytes of a file named by a relative URI; nothing if it is missing or not allowed.
  using Beside = std::function<std::optional<std::string>(const std::string& uri)>;
  explicit GltfDocument(std::string_view bytes, Beside beside = {});
  ~GltfDocument();

  const nlohmann::json& root() const { return *json_; }
  /// Returns element `index` of the top-level array `key`; an empty object if there is none.
  const nlohmann::json& At(const char* key, std::int64_t index) const;
  std::size_t Count(const char* key) const;

  /// As Numbers, but exact for integers of 32 bits.
  std::vector<double> Values(std::int64_t accessor, int width) const;
  /// Returns the numbers of an accessor, `width` for each element. Normalised integers are
  /// converted to 0..1 (-1..1 if signed), sparse values are substituted.
  std::vector<float> Numbers(std::int64_t accessor, int width) const;
  std::vector<std::uint32_t> Indices(std::int64_t accessor) const;
  /// Returns the bytes of images[index], from a bufferView, a data URI or a file.
  std::string ImageBytes(std::int64_t index) const;

 private:
  struct BufferView {
    std::span<const std::uint8_t> bytes;
    std::size_t stride = 0;  // 0 = tightly packed
  };
  /// The chunks of a binary file: JSON, and the buffer if there is one.
  struct Chunks {
    std::string_view json;
    std::optional<std::string_view> buffer;
  };
  /// Elements of `width` numbers each; `where` has their bufferView and byteOffset. REQUIRES: a
  /// known component type.
  struct Elements {
    const nlohmann::json& where;
    std::int64_t component;
    std::size_t count, width;
    bool normalised;
  };
  using Take = std::function<void(std::size_t element, std::size_t k, double value)>;

  static Chunks SplitBinary(std::string_view bytes);
  void ParseJson(std::string_view text);
  void ReadBuffers(std::optional<std::string_view> own);
  /// `place`: where in the document they are, for messages.
  void ReadElements(const Elements& elements, const std::string& place, const Take& take) const;
  /// Overwrites the values of `out` that the accessor's `sparse` replaces.
  void FillSparse(const Elements& own, const std::string& place, std::vector<double>& out) const;
  BufferView ViewOf(std::int64_t view) const;
  std::string Resolve(const std::string& uri) const;

  std::unique_ptr<nlohmann::json> json_;
  std::vector<std::string> buffers_;
  Beside beside_;
};

/// The error text for geometry in an unsupported compression.
inline constexpr const char* kPackedMesh =
    "its geometry is compressed (Draco or meshopt), which is not read; export it uncompressed";

/// Returns an integer member, or `otherwise` if it is missing or not an integer.
std::int64_t JsonInteger(const nlohmann::json& object, const char* key,
                         std::int64_t otherwise = -1);
double JsonNumber(const nlohmann::json& object, const char* key, double otherwise);
std::string JsonText(const nlohmann::json& object, const char* key);
/// Returns a member that is an array or object; an empty one if it is missing or of another type.
const nlohmann::json& JsonMember(const nlohmann::json& object, const char* key);
/// Returns the integers of an array member.
std::vector<std::int64_t> JsonIntegers(const nlohmann::json& object, const char* key);
/// Copies the numbers of an array member into `out`; elements that are not numbers leave theirs
/// unchanged.
void JsonNumbers(const nlohmann::json& object, const char* key, std::span<float> out);

}  // namespace fsm
