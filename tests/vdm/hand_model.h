#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vdm {

/// An acoustic model by hand with 32 Gaussians a codebook, written as Sphinx does. The first of
/// each stands at phone + stream in all numbers, the others far away.
class HandModel {
 public:
  HandModel(std::vector<std::string> phones, const std::string& name)
      : folder(std::filesystem::path(testing::TempDir()) / name), phones_(std::move(phones)) {
    std::filesystem::create_directories(folder);
    Definition("BMDF");
    Gaussians("means", [](std::size_t phone, std::size_t stream, std::size_t density) {
      return density == 0 ? static_cast<float>(phone + stream) : 1000.0F;
    });
    Gaussians("variances", [](std::size_t, std::size_t stream, std::size_t) {
      return 1.0F + static_cast<float>(stream);
    });
    Weights(plain());
  }
  ~HandModel() { std::filesystem::remove_all(folder); }
  template <typename T>
  static std::string Bytes(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }
  unsigned plain() const { return 3 * static_cast<unsigned>(phones_.size()); }
  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
  /// With phones by themselves only, and then `contexts` behind their names.
  void Definition(const std::string& magic, const std::string& contexts = "",
                  unsigned triphones = 0, unsigned more_senones = 0, unsigned nodes = 0) const {
    const auto count = static_cast<unsigned>(phones_.size());
    std::string bytes = magic + Bytes(1U) + Bytes(4U) + "text";
    for (const unsigned n : {count, count + triphones, 3U, plain(), plain() + more_senones, 2U,
                             count + triphones, 3U, nodes, count - 1}) {
      bytes += Bytes(n);
    }
    std::string names;
    for (const std::string& phone : phones_) names += phone + '\0';
    names.resize((names.size() + 3) / 4 * 4);
    Write("mdef", bytes + names + contexts);
  }
  /// A triphone: `phone` inside a word between `left` and `right` has three states of its own.
  void OneContext(std::int16_t phone, std::int16_t left, std::int16_t right) const {
    const auto count = static_cast<unsigned>(phones_.size());
    std::string bytes;
    const auto node = [&](std::int16_t context, std::uint16_t below, unsigned at) {
      bytes += Bytes(context) + Bytes(below) + Bytes(at);
    };
    node(0, 1, 4);
    for (std::int16_t place = 1; place < 4; ++place) node(place, 0, 0xFFFFFFFF);
    node(phone, 1, 5);
    node(left, 1, 6);
    node(right, 0, count);
    for (unsigned i = 0; i <= count; ++i) {
      const bool triphone = i == count;
      bytes += Bytes(i) + Bytes(0U);
      bytes += std::string{0, static_cast<char>(triphone ? phone : 0), 0, 0};
    }
    bytes += Bytes(3 * (count + 1));
    for (std::uint16_t senone = 0; senone < 3 * (count + 1); ++senone) bytes += Bytes(senone);
    Definition("BMDF", bytes, 1, 3, 7);
    Weights(plain() + 3);
  }
  template <typename Value>
  void Gaussians(const std::string& name, Value value, unsigned streams = 3) const {
    const auto count = static_cast<unsigned>(phones_.size());
    std::string bytes = "s3\nversion 1.0\nendhdr\n" + Bytes(0x11223344U);
    for (const unsigned n : {count, streams, 32U, 13U, 13U, 13U, count * 3U * 32U * 13U}) {
      bytes += Bytes(n);
    }
    for (std::size_t i = 0; i < count * 3U * 32U; ++i) {
      for (int k = 0; k < 13; ++k) bytes += Bytes(float{value(i / 96, i / 32 % 3, i % 32)});
    }
    Write(name, bytes);
  }
  /// The first phone's middle state, and all states of a triphone, weigh less by 10 steps.
  void Weights(unsigned states) const {
    std::string bytes =
        Bytes(5U) + std::string("head\0", 5) + Bytes(0U) + Bytes(32U) + Bytes(states);
    for (int row = 0; row < 3 * 32; ++row) {
      for (unsigned s = 0; s < states; ++s) {
        bytes += static_cast<char>(s == 1 || s >= plain() ? 10 : 0);
      }
    }
    Write("sendump", bytes);
  }
  const std::filesystem::path folder;

 private:
  const std::vector<std::string> phones_;
};

}  // namespace vdm
