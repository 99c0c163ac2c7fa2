#include "fsm/asset/asset_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "fsm/asset/asset_members.h"
#include "fsm/asset/gltf_builder.h"
#include "fsm/asset/material_name.h"
#include "fsm/base/box.h"
#include "fsm/image/image_codec.h"

namespace fsm {
namespace {

using nlohmann::json;

constexpr float kMetres = 0.001f;
constexpr float kMinMm = 0.01f;  ///< a morph target leaves out smaller displacements

template <typename T>
constexpr GltfType TypeOf() {
  if constexpr (std::is_same_v<T, float>) return GltfType::kFloat;
  if constexpr (std::is_same_v<T, std::uint32_t>) return GltfType::kUint32;
  if constexpr (std::is_same_v<T, std::int8_t>) return GltfType::kInt8;
  if constexpr (std::is_same_v<T, std::int16_t>) return GltfType::kInt16;
  return GltfType::kUint8;
}

/// The type in which a column stores a number.
template <typename T>
using Stored = std::conditional_t<std::is_same_v<T, bool> || std::is_enum_v<T>, std::uint8_t,
                                  std::conditional_t<std::is_same_v<T, int>, std::int16_t, T>>;

template <typename T>
concept Number = std::is_enum_v<T> || std::is_arithmetic_v<T>;

/// Returns the numbers of one element of a column.
template <Number T>
std::array<Stored<T>, 1> NumbersOf(T value) {
  return {static_cast<Stored<T>>(value)};
}
std::array<std::uint32_t, 2> NumbersOf(const std::pair<std::uint32_t, std::uint32_t>& pair) {
  return {pair.first, pair.second};
}
template <glm::length_t L>
std::array<float, L> NumbersOf(const glm::vec<L, float>& v) {
  std::array<float, L> numbers;
  for (glm::length_t k = 0; k < L; ++k) numbers[static_cast<std::size_t>(k)] = v[k];
  return numbers;
}

/// An accessor under construction: elements of one type.
class Column {
 public:
  template <typename T>
  void Add(const T& element) {
    const auto numbers = NumbersOf(element);
    type_ = TypeOf<typename decltype(numbers)::value_type>();
    width_ = static_cast<int>(numbers.size());
    const auto bytes = std::as_bytes(std::span(numbers));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    ++count_;
  }
  std::size_t Finish(GltfBuilder& gltf) const {
    return gltf.AddAccessor(gltf.AddView(bytes_), count_, width_, type_);
  }

 private:
  std::vector<std::byte> bytes_;
  std::size_t count_ = 0;
  int width_ = 0;
  GltfType type_{};
};

/// Writes members as JSON, and arrays of numbers as accessors that the JSON refers to by index.
class Writer {
 public:
  explicit Writer(GltfBuilder& gltf) : gltf_(gltf) {}

  /// Returns the JSON of any type that Members accepts, or of a part of it.
  template <typename T>
  json Write(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return static_cast<int>(value);
    } else if constexpr (std::is_same_v<T, float>) {
      return std::isfinite(value) ? json(value) : json();
    } else if constexpr (std::is_arithmetic_v<T>) {
      return value;
    } else {
      return WriteObject(value);
    }
  }

 private:
  template <glm::length_t L>
  json WriteObject(const glm::vec<L, float>& v) {
    return NumbersOf(v);
  }
  template <typename T, std::size_t N>
  json WriteObject(const std::array<T, N>& items) {
    json list = json::array();
    for (const T& item : items) list.push_back(Write(item));
    return list;
  }
  template <typename T>
  json WriteObject(const Sided<T>& items) {
    return json::array({Write(items.right), Write(items.left)});
  }
  template <typename T>
  json WriteObject(const std::optional<T>& value) {
    return value ? Write(*value) : json();
  }
  json WriteObject(const Landmarks& landmarks) {
    json object = json::object();
    for (const auto& [name, place] : landmarks) object[name] = NumbersOf(place);
    return object;
  }
  json WriteObject(const std::shared_ptr<const Image>& image) {
    if (!image) return {};
    const auto [known, added] = images_.try_emplace(image.get(), gltf_.document["images"].size());
    if (added) {
      const auto png = EncodePng(*image);
      gltf_.document["images"].push_back(
          {{"mimeType", "image/png"},
           {"bufferView", gltf_.AddView(std::as_bytes(std::span(png)))}});
    }
    return known->second;
  }
  template <typename T>
  json WriteObject(const std::vector<T>& items) {
    if (items.empty()) return json::array();
    if constexpr (Tabular<T>) {
      return WriteTable(items);
    } else if constexpr (requires { NumbersOf(items.front()); }) {
      Column column;
      for (const T& item : items) column.Add(item);
      return column.Finish(gltf_);
    } else {
      json list = json::array();
      for (const T& item : items) list.push_back(Write(item));
      return list;
    }
  }
  template <typename T>
  json WriteObject(const T& object) {
    json members = json::object();
    const auto member = [&](const char* name, const auto& value) { members[name] = Write(value); };
    Members(member, object);
    return members;
  }

  /// Writes one column for each member.
  template <typename T>
  json WriteTable(const std::vector<T>& items) {
    std::vector<std::pair<const char*, Column>> columns;
    for (const T& item : items) {
      std::size_t at = 0;
      const auto add = [&](const char* name, const auto& value) {
        if (at == columns.size()) columns.emplace_back(name, Column());
        columns[at++].second.Add(value);
      };
      Members(add, item);
    }
    json accessors = json::object();
    for (const auto& [name, column] : columns) accessors[name] = column.Finish(gltf_);
    return accessors;
  }

  GltfBuilder& gltf_;
  std::map<const Image*, std::size_t> images_;
};

/// The part of the file that other programs display.
class ForeignView {
 public:
  ForeignView(GltfBuilder& gltf, const Head& head, const json& extension)
      : gltf_(gltf), head_(head), surface_(head.surface()), extension_(extension) {}

  void Write(std::span<const ExportedShape> shapes) {
    const json &rig = extension_["rig"], &surface = extension_["surface"];
    position_ = rig["rest"];
    MarkBounds(head_.rig().data().rest, gltf_.document["accessors"][position_]);
    normal_ = rig["rest_normal"];
    colour_ = surface["albedo"];
    if (surface_.textures.base_colour) WriteTexture(surface["image"]);
    json names = json::array(), targets = json::array();
    HeadVertices rest, moved;
    head_.Evaluate({}, rest);
    for (const ExportedShape& shape : shapes) {
      head_.Evaluate(shape.state, moved);
      names.push_back(shape.name);
      targets.push_back({{"POSITION", Target(rest, moved)}});
    }
    json& document = gltf_.document;
    json primitives = json::array();
    for (const HeadSurface::Part& part : surface_.parts) {
      // Programs that cannot fade in the lashes of shut lids must not show them.
      if (part.material == Material::kShutLash || part.index_count == 0) continue;
      primitives.push_back(Primitive(part, surface["indices"]));
      if (!targets.empty()) primitives.back()["targets"] = targets;
    }
    json& mesh = document["meshes"][0];
    mesh["name"] = "head";
    mesh["primitives"] = std::move(primitives);
    if (!shapes.empty()) {
      mesh["extras"]["targetNames"] = std::move(names);
      mesh["weights"] = std::vector<int>(shapes.size(), 0);
    }
    document["nodes"] =
        json::array({{{"mesh", 0}, {"name", "head"}, {"scale", {kMetres, kMetres, kMetres}}}});
    document["scenes"] = json::array({{{"nodes", {0}}}});
    document["scene"] = 0;
  }

 private:
  static void MarkBounds(std::span<const glm::vec3> places, json& accessor) {
    const Box box = Box::Of(places);
    accessor["min"] = NumbersOf(box.low);
    accessor["max"] = NumbersOf(box.high);
  }

  void WriteTexture(const json& image) {
    const std::span<const glm::vec2> places(surface_.textures.texcoord);
    texcoord_ = gltf_.AddAccessor(gltf_.AddView(places), places.size(), 2, GltfType::kFloat);
    gltf_.document["textures"] = json::array({{{"source", image}}});
  }

  /// Tells whether most vertices of a part show the photo.
  bool ShowsPhoto(const HeadSurface::Part& part) const {
    if (!surface_.textures.base_colour) return false;
    const auto shown = std::ranges::count_if(surface_.Corners(part), [this](std::uint32_t vertex) {
      return surface_.textures.weight[vertex] > 0.5f;
    });
    return 2 * shown > part.index_count;
  }

  json Primitive(const HeadSurface::Part& part, const json& indices) {
    const json& all = gltf_.document["accessors"][indices.get<std::size_t>()];
    const std::size_t triangles =
        gltf_.AddAccessor(all["bufferView"], part.index_count, 1, GltfType::kUint32,
                          sizeof(std::uint32_t) * part.first_index);
    const bool photo = ShowsPhoto(part);
    // Other programs do not know that hair has a lining.
    json material = {{"name", MaterialName(part.material)},
                     {"doubleSided", part.two_sided || HasTwoSides(part.material) ||
                                         part.material == Material::kHair},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.7}}}};
    json attributes = {{"POSITION", position_}, {"NORMAL", normal_}};
    if (photo) {
      attributes["TEXCOORD_0"] = texcoord_;
      material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    } else {
      attributes["COLOR_0"] = colour_;
    }
    gltf_.document["materials"].push_back(std::move(material));
    return {{"attributes", std::move(attributes)},
            {"indices", triangles},
            {"material", gltf_.document["materials"].size() - 1}};
  }

  /// Adds a sparse accessor of the vertices that a state moves; returns its index.
  std::size_t Target(const HeadVertices& rest, const HeadVertices& moved) {
    std::vector<std::uint32_t> which;
    std::vector<glm::vec3> by;
    for (std::uint32_t i = 0; i < rest.position.size(); ++i) {
      const glm::vec3 d = moved.position[i] - rest.position[i];
      if (glm::length(d) < kMinMm) continue;
      which.push_back(i);
      by.push_back(d);
    }
    if (which.empty()) {  // a sparse accessor needs at least one element
      which.push_back(0);
      by.emplace_back(0.0f);
    }
    json accessor = {{"componentType", static_cast<int>(GltfType::kFloat)},
                     {"count", rest.position.size()},
                     {"type", "VEC3"}};
    const std::size_t indices = gltf_.AddView(std::span<const std::uint32_t>(which)),
                      values = gltf_.AddView(std::span<const glm::vec3>(by));
    accessor["sparse"] = {
        {"count", which.size()},
        {"indices",
         {{"bufferView", indices}, {"componentType", static_cast<int>(GltfType::kUint32)}}},
        {"values", {{"bufferView", values}}}};
    by.emplace_back(0.0f);  // for the vertices that do not move
    MarkBounds(by, accessor);
    gltf_.document["accessors"].push_back(std::move(accessor));
    return gltf_.document["accessors"].size() - 1;
  }

  GltfBuilder& gltf_;
  const Head& head_;
  const HeadSurface& surface_;
  const json& extension_;
  std::size_t position_ = 0, normal_ = 0, colour_ = 0, texcoord_ = 0;
};

}  // namespace

std::string WriteAsset(const Head& head, std::span<const ExportedShape> shapes) {
  GltfBuilder gltf;
  Writer writer(gltf);
  json extension = {{"version", kAssetVersion}};
  extension["surface"] = writer.Write(head.surface());
  extension["rig"] = writer.Write(head.rig().data());
  extension["rig"]["unit_effects"] = head.rig().data().units.Text();
  extension["landmarks"] = writer.Write(head.landmarks());
  extension["view"] = writer.Write(head.view());
  ForeignView(gltf, head, extension).Write(shapes);
  gltf.document["asset"] = {{"version", "2.0"}, {"generator", "Galatea " GALATEA_VERSION}};
  gltf.document["extensionsUsed"] = {kAssetExtension};
  gltf.document["extensions"][kAssetExtension] = std::move(extension);
  return gltf.Finish();
}

}  // namespace fsm
