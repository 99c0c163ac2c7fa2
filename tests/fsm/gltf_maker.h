#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

namespace fsm {

/// Makes small glTF files (JSON with its buffer inside) for tests. What it returns are the numbers
/// of accessors and images; nodes, meshes and the rest are given as JSON.
class GltfMaker {
 public:
  int Floats(const std::vector<float>& numbers, const char* type, std::size_t width) {
    return Accessor(View(numbers), 5126, numbers.size() / width, type, "");
  }
  int Places(const std::vector<float>& numbers) { return Floats(numbers, "VEC3", 3); }
  int Bytes(const std::vector<std::uint8_t>& numbers, const char* type, std::size_t width) {
    return Accessor(View(numbers), 5121, numbers.size() / width, type, "");
  }
  int Shorts(const std::vector<std::int16_t>& numbers, const char* type, std::size_t width) {
    return Accessor(View(numbers), 5122, numbers.size() / width, type, R"(,"normalized":true)");
  }
  /// `count` normalised shorts of VEC3, zero but for one.
  int SparseShorts(std::size_t count, std::uint16_t where, const std::vector<std::int16_t>& what) {
    const int at = View(std::vector<std::uint16_t>{where}), value = View(what);
    return Accessor(-1, 5122, count, "VEC3",
                    R"(,"normalized":true,"sparse":{"count":1,"indices":{"bufferView":)" +
                        std::to_string(at) + R"(,"componentType":5123},"values":{"bufferView":)" +
                        std::to_string(value) + "}}");
  }
  int Picture(const std::vector<std::uint8_t>& bytes) {
    Append(images_, R"({"bufferView":)" + std::to_string(View(bytes)) + "}");
    Append(textures_, R"({"source":)" + std::to_string(pictures_) + "}");
    return pictures_++;
  }
  /// `rest`: members of the top object, beginning with "nodes".
  std::string File(const std::string& rest) const {
    return R"({"asset":{"version":"2.0"},)" + rest + R"(,"accessors":[)" + accessors_ +
           R"(],"bufferViews":[)" + views_ + R"(],"images":[)" + images_ + R"(],"textures":[)" +
           textures_ + R"(],"buffers":[{"byteLength":)" + std::to_string(bytes_.size()) +
           R"(,"uri":"data:application/octet-stream;base64,)" + Base64() + R"("}]})";
  }

 private:
  template <typename T>
  int View(const std::vector<T>& numbers) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t from = bytes_.size(), size = numbers.size() * sizeof(T);
    bytes_.resize(from + size);
    std::memcpy(bytes_.data() + from, numbers.data(), size);
    Append(views_, R"({"buffer":0,"byteOffset":)" + std::to_string(from) + R"(,"byteLength":)" +
                       std::to_string(size) + "}");
    return view_count_++;
  }
  int Accessor(int view, int component, std::size_t count, const char* type,
               const std::string& more) {
    Append(accessors_,
           "{" + (view < 0 ? std::string() : R"("bufferView":)" + std::to_string(view) + ",") +
               R"("componentType":)" + std::to_string(component) + R"(,"count":)" +
               std::to_string(count) + R"(,"type":")" + type + "\"" + more + "}");
    return accessor_count_++;
  }
  static void Append(std::string& list, const std::string& item) {
    list += (list.empty() ? "" : ",") + item;
  }
  std::string Base64() const {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes_.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        bits = bits << 8 | (i + k < bytes_.size() ? bytes_[i + k] : 0U);
      }
      for (std::size_t k = 0; k < 4; ++k) {
        out += i + k <= bytes_.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
      }
    }
    return out;
  }

  std::vector<std::uint8_t> bytes_;
  std::string views_, accessors_, images_, textures_;
  int view_count_ = 0, accessor_count_ = 0, pictures_ = 0;
};

}  // namespace fsm
