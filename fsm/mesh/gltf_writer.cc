#include "fsm/mesh/gltf_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <nlohmann/json.hpp>

namespace fsm {
namespace {

using nlohmann::json;

constexpr float kMetres = 0.001f;
constexpr float kLeastMm = 0.01f;  ///< what moves less does not move

const char* NameOf(Material material) {
  switch (material) {
    case Material::kSkin:
      return "skin";
    case Material::kLip:
      return "lips";
    case Material::kSclera:
      return "eye_white";
    case Material::kIris:
      return "eye_iris";
    case Material::kPupil:
      return "eye_pupil";
    case Material::kTeeth:
      return "teeth";
    case Material::kGum:
      return "gums";
    case Material::kTongue:
      return "tongue";
    case Material::kMouthInside:
      return "mouth";
    case Material::kLash:
    case Material::kShutLash:
      return "lashes";
    case Material::kHair:
      return "hair";
    case Material::kCloth:
      return "cloth";
    case Material::kPhoto:
      return "photo";
  }
  return "part";
}

class Writer {
 public:
  std::string Write(const Head& head, std::span<const ExportedShape> shapes) {
    HeadVertices rest;
    head.Evaluate({}, rest);
    const auto& topology = head.topology();
    std::vector<HeadVertices> moved(shapes.size());
    json names = json::array();
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      head.Evaluate(shapes[k].state, moved[k]);
      names.push_back(shapes[k].name);
    }
    json primitives = json::array();
    // All of a material in one, with vertices of its own.
    std::map<Material, std::vector<std::uint32_t>> corners;
    for (const auto& part : topology.parts) {
      if (part.material == Material::kShutLash) continue;  // a file's lids have no moment for them
      auto& all = corners[part.material];
      all.insert(all.end(), topology.indices.begin() + part.first_index,
                 topology.indices.begin() + part.first_index + part.index_count);
    }
    for (const auto& [material, indices] : corners) {
      if (indices.empty()) continue;
      primitives.push_back(Primitive(topology, rest, moved, material, indices));
    }
    json& mesh = document_["meshes"][0];
    mesh["name"] = "head";
    mesh["primitives"] = std::move(primitives);
    mesh["extras"]["targetNames"] = std::move(names);
    mesh["weights"] = std::vector<int>(shapes.size(), 0);
    document_["asset"] = {{"version", "2.0"}, {"generator", "Galatea " GALATEA_VERSION}};
    document_["nodes"] = json::array({{{"mesh", 0}, {"name", "head"}}});
    document_["scenes"] = json::array({{{"nodes", {0}}}});
    document_["scene"] = 0;
    document_["buffers"] = json::array({{{"byteLength", buffer_.size()}}});
    return Bind();
  }

 private:
  json Primitive(const HeadTopology& topology, const HeadVertices& rest,
                 const std::vector<HeadVertices>& moved, Material material,
                 const std::vector<std::uint32_t>& indices) {
    std::vector<std::uint32_t> own, of(rest.position.size(), 0xffffffffU), mine;
    for (const std::uint32_t v : indices) {
      if (of[v] == 0xffffffffU) {
        of[v] = static_cast<std::uint32_t>(own.size());
        own.push_back(v);
      }
      mine.push_back(of[v]);
    }
    std::vector<glm::vec3> position, normal;
    std::vector<glm::vec4> colour;
    glm::vec3 low(1e9f), high(-1e9f);
    for (const std::uint32_t v : own) {
      position.push_back(rest.position[v] * kMetres);
      normal.push_back(glm::normalize(rest.normal[v] + glm::vec3(0, 0, 1e-9f)));
      colour.emplace_back(topology.albedo[v], 1.0f);
      low = glm::min(low, position.back());
      high = glm::max(high, position.back());
    }
    json primitive;
    json& attributes = primitive["attributes"];
    attributes["POSITION"] = Accessor(View(position), own.size(), "VEC3");
    json& place = document_["accessors"].back();
    place["min"] = {low.x, low.y, low.z};
    place["max"] = {high.x, high.y, high.z};
    attributes["NORMAL"] = Accessor(View(normal), own.size(), "VEC3");
    attributes["COLOR_0"] = Accessor(View(colour), own.size(), "VEC4");
    primitive["indices"] = Accessor(View(mine), mine.size(), "SCALAR", 5125);
    json targets = json::array();
    for (const HeadVertices& state : moved) targets.push_back(Target(rest, state, own));
    if (!targets.empty()) primitive["targets"] = std::move(targets);
    primitive["material"] = document_["materials"].size();
    document_["materials"].push_back(
        {{"name", NameOf(material)},
         {"doubleSided", IsHair(material) || material == Material::kMouthInside},
         {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.7}}}});
    return primitive;
  }

  json Target(const HeadVertices& rest, const HeadVertices& state,
              const std::vector<std::uint32_t>& own) {
    std::vector<std::uint32_t> which;
    std::vector<glm::vec3> by;
    glm::vec3 low(0), high(0);
    for (std::uint32_t i = 0; i < own.size(); ++i) {
      const glm::vec3 d = state.position[own[i]] - rest.position[own[i]];
      if (glm::length(d) < kLeastMm) continue;
      which.push_back(i);
      by.push_back(d * kMetres);
      low = glm::min(low, by.back());
      high = glm::max(high, by.back());
    }
    // A sparse accessor without a view is zero elsewhere; it must name one element at least.
    if (which.empty()) {
      which.push_back(0);
      by.emplace_back(0.0f);
    }
    json accessor = {{"componentType", 5126},
                     {"count", own.size()},
                     {"type", "VEC3"},
                     {"min", {low.x, low.y, low.z}},
                     {"max", {high.x, high.y, high.z}}};
    const std::size_t indices = View(which), values = View(by);
    accessor["sparse"] = {{"count", which.size()},
                          {"indices", {{"bufferView", indices}, {"componentType", 5125}}},
                          {"values", {{"bufferView", values}}}};
    document_["accessors"].push_back(std::move(accessor));
    return {{"POSITION", document_["accessors"].size() - 1}};
  }

  template <typename T>
  std::size_t View(const std::vector<T>& items) {
    const std::size_t bytes = items.size() * sizeof(T);
    document_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}});
    buffer_.append(reinterpret_cast<const char*>(items.data()), bytes);
    return document_["bufferViews"].size() - 1;
  }

  std::size_t Accessor(std::size_t view, std::size_t count, const char* type,
                       int component = 5126) {
    document_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return document_["accessors"].size() - 1;
  }

  std::string Bind() const {
    std::string text = document_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string buffer = buffer_;
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    std::string out;
    const auto word = [&out](std::size_t value) {
      for (int k = 0; k < 4; ++k) out += static_cast<char>(value >> (8 * k) & 0xff);
    };
    word(0x46546C67);  // "glTF"
    word(2);
    word(12 + 8 + text.size() + 8 + buffer.size());
    word(text.size());
    word(0x4E4F534A);
    out += text;
    word(buffer.size());
    word(0x004E4942);
    return out + buffer;
  }

  json document_ = json::object();
  std::string buffer_;
};

}  // namespace

std::string WriteGltfHead(const Head& head, std::span<const ExportedShape> shapes) {
  return Writer().Write(head, shapes);
}

}  // namespace fsm
