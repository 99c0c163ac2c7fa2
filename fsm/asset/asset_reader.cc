#include "fsm/asset/asset_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "fsm/asset/asset_members.h"
#include "fsm/asset/check_asset.h"
#include "fsm/image/byte_order.h"
#include "fsm/image/image_codec.h"
#include "fsm/mesh/gltf/gltf_document.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

using nlohmann::json;

/// Number of components of one element of a column.
template <typename M>
constexpr std::size_t kWidth = 1;
template <glm::length_t L>
constexpr std::size_t kWidth<glm::vec<L, float>> = L;

/// Reads a file of asset_writer.cc, by the same lists of members.
class Reader {
 public:
  explicit Reader(const GltfDocument& gltf) : gltf_(gltf) {}

  template <typename T>
  void Read(const std::string& place, const json& from, T& value) {
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(Whole(place, from, 0, kValuesOf<T> - 1));
    } else if constexpr (std::is_same_v<T, bool>) {
      if (!from.is_boolean()) RefuseFile(place + ": true or false expected");
      value = from.get<bool>();
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(
          Whole(place, from, std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
    } else if constexpr (std::is_same_v<T, float>) {
      if (from.is_null() && !std::isfinite(value)) return;
      value = Real(place, from);
    } else {
      ReadObject(place, from, value);
    }
  }

 private:
  static std::int64_t Whole(const std::string& place, const json& from, std::int64_t min,
                            std::int64_t max) {
    if (!from.is_number_integer()) RefuseFile(place + ": a whole number expected");
    const auto value = from.get<std::int64_t>();
    if (value < min || value > max) {
      RefuseFile(fmt::format("{}: {} found, {} to {} expected", place, value, min, max));
    }
    return value;
  }
  static float Real(const std::string& place, const json& from) {
    const float value = from.is_number() ? from.get<float>() : NAN;
    if (!std::isfinite(value)) RefuseFile(place + ": a number expected");
    return value;
  }
  static void NeedList(const std::string& place, const json& from, std::size_t size) {
    if (!from.is_array() || from.size() != size) {
      RefuseFile(fmt::format("{}: a list of {} expected", place, size));
    }
  }
  template <glm::length_t L>
  void ReadObject(const std::string& place, const json& from, glm::vec<L, float>& v) {
    NeedList(place, from, static_cast<std::size_t>(L));
    for (glm::length_t k = 0; k < L; ++k) v[k] = Real(place, from[static_cast<std::size_t>(k)]);
  }
  template <typename T, std::size_t N>
  void ReadObject(const std::string& place, const json& from, std::array<T, N>& items) {
    NeedList(place, from, N);
    for (std::size_t i = 0; i < N; ++i) Read(place, from[i], items[i]);
  }
  template <typename T>
  void ReadObject(const std::string& place, const json& from, Sided<T>& items) {
    NeedList(place, from, kSides.size());
    for (const Side side : kSides) Read(place, from[static_cast<std::size_t>(side)], items[side]);
  }
  template <typename T>
  void ReadObject(const std::string& place, const json& from, std::optional<T>& value) {
    if (!from.is_null()) Read(place, from, value.emplace());
  }
  void ReadObject(const std::string& place, const json& from, Landmarks& landmarks) {
    if (!from.is_object()) RefuseFile(place + ": an object of places expected");
    for (const auto& [name, at] : from.items()) Read(place + "." + name, at, landmarks[name]);
  }
  void ReadObject(const std::string& place, const json& from, std::shared_ptr<const Image>& image) {
    if (from.is_null()) return;
    const std::int64_t index = Whole(place, from, 0, std::numeric_limits<int>::max());
    image = AtPlace(place, [&] {
      return std::make_shared<const Image>(
          vm::OrThrow(DecodePng(BytesOf(gltf_.ImageBytes(index)))));
    });
  }
  template <typename T>
  void ReadObject(const std::string& place, const json& from, std::vector<T>& items) {
    if (from.is_array() && from.empty()) return;
    if constexpr (Tabular<T>) {
      ReadTable(place, from, items);
    } else if constexpr (std::is_same_v<T, std::pair<std::uint32_t, std::uint32_t>>) {
      const auto numbers = Column(place, from, 2);
      for (std::size_t i = 0; i < numbers.size(); i += 2)
        items.emplace_back(Narrow<std::uint32_t>(place, numbers[i]),
                           Narrow<std::uint32_t>(place, numbers[i + 1]));
    } else if constexpr (requires { T::length(); }) {
      const auto numbers = Column(place, from, T::length());
      items.resize(numbers.size() / kWidth<T>);
      for (std::size_t i = 0; i < items.size(); ++i) Fill(place, &numbers[i * kWidth<T>], items[i]);
    } else if constexpr (std::is_enum_v<T> || std::is_arithmetic_v<T>) {
      for (const double number : Column(place, from, 1)) items.push_back(Narrow<T>(place, number));
    } else {
      if (!from.is_array()) RefuseFile(place + ": a list expected");
      for (std::size_t i = 0; i < from.size(); ++i)
        Read(fmt::format("{}[{}]", place, i), from[i], items.emplace_back());
    }
  }
  template <typename T>
  void ReadObject(const std::string& place, const json& from, T& object) {
    const auto member = [&](const char* name, auto& value) {
      Read(place + "." + name, MemberOf(place, from, name), value);
    };
    Members(member, object);
  }

  const json& MemberOf(const std::string& place, const json& from, std::string_view name) const {
    const auto found = from.is_object() ? from.find(name) : from.end();
    if (!from.is_object() || found == from.end()) {
      RefuseFile(fmt::format("{}: no member \"{}\"", place, name));
    }
    return *found;
  }

  /// Returns the numbers of an accessor.
  std::vector<double> Column(const std::string& place, const json& from, int width) const {
    const std::int64_t index = Whole(place, from, 0, std::numeric_limits<int>::max());
    return AtPlace(place, [&] { return gltf_.Values(index, width); });
  }
  template <typename T>
  static T Narrow(const std::string& place, double number) {
    if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(number);
    } else {
      double min = 0, max = 1;
      if constexpr (std::is_enum_v<T>) {
        max = kValuesOf<T> - 1;
      } else if constexpr (!std::is_same_v<T, bool>) {
        min = std::numeric_limits<T>::min();
        max = std::numeric_limits<T>::max();
      }
      if (!(number >= min && number <= max)) {
        RefuseFile(fmt::format("{}: {} is out of range", place, number));
      }
      return static_cast<T>(static_cast<std::int64_t>(number));
    }
  }

  template <typename T>
  void ReadTable(const std::string& place, const json& from, std::vector<T>& items) {
    struct TableColumn {
      std::string place;
      std::vector<double> numbers;
    };
    std::vector<TableColumn> columns;
    const auto read = [&]<typename M>(const char* name, M&) {
      std::string where = place + "." + name;
      auto numbers = Column(where, MemberOf(place, from, name), static_cast<int>(kWidth<M>));
      const std::size_t count = numbers.size() / kWidth<M>;
      if (columns.empty()) items.resize(count);
      if (items.size() != count) RefuseFile(where + ": as many as in the first column expected");
      columns.push_back({std::move(where), std::move(numbers)});
    };
    T sample{};
    Members(read, sample);
    for (std::size_t i = 0; i < items.size(); ++i) {
      std::size_t at = 0;
      const auto fill = [&]<typename M>(const char*, M& value) {
        const auto& [where, numbers] = columns[at++];
        Fill(where, &numbers[i * kWidth<M>], value);
      };
      Members(fill, items[i]);
    }
  }
  template <typename M>
  static void Fill(const std::string& place, const double* numbers, M& value) {
    if constexpr (requires { M::length(); }) {
      for (glm::length_t k = 0; k < M::length(); ++k) value[k] = static_cast<float>(numbers[k]);
    } else {
      value = Narrow<M>(place, *numbers);
    }
  }

  const GltfDocument& gltf_;
};

HeadAsset ReadAsset(const GltfDocument& gltf, const json& from) {
  if (JsonInteger(from, "version") != kAssetVersion) {
    RefuseFile(fmt::format("version: {} expected", kAssetVersion));
  }
  Reader reader(gltf);
  HeadAsset asset;
  const auto read = [&](const char* name, auto& member) {
    const auto found = from.find(name);
    if (found == from.end()) RefuseFile("no member \"" + std::string(name) + "\"");
    reader.Read(name, *found, member);
  };
  read("surface", asset.surface);
  read("rig", asset.rig);
  read("landmarks", asset.landmarks);
  read("view", asset.view);
  asset.rig.units = vm::OrThrow(ReadTable("rig.unit_effects", JsonText(from["rig"], "unit_effects"),
                                          [](const Table& table) { return UnitTable(table); }));
  CheckAsset(asset);
  return asset;
}

}  // namespace

bool IsAsset(std::string_view bytes) {
  const std::string quoted = "\"" + std::string(kAssetExtension) + "\"";
  return bytes.starts_with("glTF") && bytes.find(quoted) != std::string_view::npos;
}

vm::Result<HeadAsset> ParseAsset(const std::string& name, std::string_view bytes) try {
  return AtPlace(name, [&] {
    const GltfDocument gltf(bytes);
    const json& extension = JsonMember(JsonMember(gltf.root(), "extensions"), kAssetExtension);
    return AtPlace(kAssetExtension, [&] { return ReadAsset(gltf, extension); });
  });
} catch (const vm::Failure& failure) {
  return std::unexpected(failure.error);
}

}  // namespace fsm
