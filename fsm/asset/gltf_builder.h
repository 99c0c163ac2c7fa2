#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "fsm/mesh/gltf/gltf_document.h"

namespace fsm {

/// Builds a binary glTF 2.0 file: one buffer, and views and accessors into it.
class GltfBuilder {
 public:
  /// The JSON; the caller fills all of it except buffers, bufferViews and accessors.
  nlohmann::json document = nlohmann::json::object();

  /// Adds a view of these bytes and returns its index.
  std::size_t AddView(std::span<const std::byte> bytes) {
    buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
    buffer_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return document["bufferViews"].size() - 1;
  }
  template <typename T>
  std::size_t AddView(std::span<const T> items) {
    return AddView(std::as_bytes(items));
  }
  /// Adds an accessor and returns its index. `width`: components of each element, 1 to 4.
  std::size_t AddAccessor(std::size_t view, std::size_t count, int width, GltfType type,
                          std::size_t byte_offset = 0) {
    static constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    nlohmann::json accessor = {{"bufferView", view},
                               {"componentType", static_cast<int>(type)},
                               {"count", count},
                               {"type", kTypes[width - 1]}};
    if (byte_offset > 0) accessor["byteOffset"] = byte_offset;
    document["accessors"].push_back(std::move(accessor));
    return document["accessors"].size() - 1;
  }

  /// Returns the complete file. The builder cannot be used afterwards.
  std::string Finish() {
    document["buffers"] = nlohmann::json::array({{{"byteLength", buffer_.size()}}});
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
    std::string file;
    const auto word = [&file](std::size_t value) {
      for (int k = 0; k < 4; ++k) file += static_cast<char>(value >> (8 * k) & 0xff);
    };
    word(0x46546C67);  // "glTF"
    word(2);
    word(12 + 8 + text.size() + 8 + buffer_.size());
    word(text.size());
    word(0x4E4F534A);  // "JSON"
    file += text;
    word(buffer_.size());
    word(0x004E4942);  // "BIN"
    return file + buffer_;
  }

 private:
  std::string buffer_;
};

}  // namespace fsm
