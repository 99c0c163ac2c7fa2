#include "fsm/mesh/gltf/gltf_head.h"

#include <algorithm>
#include <glm/matrix.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/gltf_nodes.h"
#include "fsm/mesh/gltf/gltf_targets.h"
#include "fsm/mesh/gltf/gltf_textures.h"
#include "fsm/mesh/gltf/vrm_avatar.h"
#include "fsm/mesh/gltf/vrm_springs.h"
#include "fsm/mesh/mesh_limits.h"
#include "fsm/rig/reach.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

using nlohmann::json;

/// Reads one document. Throws as GltfDocument.
class GltfReader {
 public:
  GltfReader(const std::string& name, std::string_view bytes, const GltfDocument::Beside& beside)
      : document_(bytes, beside),
        avatar_(ReadVrm(document_)),
        nodes_(document_),
        springs_(document_, nodes_),
        textures_(document_, head_),
        targets_(document_, head_) {
    head_.name = name;
  }

  ImportedHead Read() {
    head_.spring_rig.springs = springs_.springs();
    for (const std::int64_t node : nodes_.shown()) ReadMesh(node);
    if (head_.parts.empty()) RefuseFile("no mesh of triangles is in it");
    for (const auto& expression : avatar_.expressions) targets_.AddExpression(expression);
    if (avatar_.eye_bone.right >= 0 && avatar_.eye_bone.left >= 0) ReadEyePivots();
    head_.eye_rig.gaze_ranges = avatar_.gaze_ranges;
    head_.gaze_by_shape = avatar_.gaze_by_shape;
    if (avatar_.faces_minus_z) TurnAround();
    if (!head_.texcoord.empty()) head_.texcoord.resize(head_.position.size(), glm::vec2(0));
    if (!head_.vertex_colour.empty())
      head_.vertex_colour.resize(head_.position.size(), glm::vec3(1));
    head_.eye.resize(head_.position.size());
    if (std::ranges::none_of(head_.eye, [](const auto& e) { return e.has_value(); })) {
      head_.eye.clear();
    }
    return std::move(head_);
  }

 private:
  void ReadEyePivots() {
    head_.eye_rig.pivot.emplace();
    for (const Side side : kSides) {
      const std::int64_t bone = avatar_.eye_bone[side];
      (*head_.eye_rig.pivot)[side] = glm::vec3(nodes_.World(bone)[3]);
      if (WithinReach((*head_.eye_rig.pivot)[side])) continue;
      RefuseReach("nodes[" + std::to_string(bone) + "]: the eye");
    }
  }

  void ReadMesh(std::int64_t node) {
    const json& of = document_.At("nodes", node);
    const std::int64_t index = JsonInteger(of, "mesh"), skin = JsonInteger(of, "skin");
    if (index < 0) return;
    if (skin >= 0 && !skins_.contains(skin)) {
      skins_.emplace(skin, GltfSkin(document_, nodes_, skin));
    }
    const json& mesh = document_.At("meshes", index);
    std::vector<std::string> names;
    for (const json& name : JsonMember(JsonMember(mesh, "extras"), "targetNames")) {
      names.push_back(name.is_string() ? name.get<std::string>() : "");
    }
    for (const json& primitive : JsonMember(mesh, "primitives")) {
      if (JsonInteger(primitive, "mode", 4) != 4) continue;
      const GltfMeshInstance instance{.mesh = index, .node = node, .skin = skin};
      ReadPrimitive(primitive, instance, JsonText(of, "name") + " " + JsonText(mesh, "name"),
                    names);
    }
  }

  void ReadPrimitive(const json& primitive, const GltfMeshInstance& instance,
                     const std::string& name, const std::vector<std::string>& names) {
    const json& attributes = JsonMember(primitive, "attributes");
    const std::int64_t position = JsonInteger(attributes, "POSITION");
    // Without a fallback the accessors of compressed geometry exist, but have no data.
    if (JsonMember(primitive, "extensions").contains("KHR_draco_mesh_compression") &&
        !document_.At("accessors", position).contains("bufferView")) {
      RefuseFile("meshes[" + std::to_string(instance.mesh) + "]: " + kPackedMesh);
    }
    // Primitives of a mesh often share their vertices.
    const GltfUvTransform uv = textures_.UvOfMaterial(JsonInteger(primitive, "material"));
    const json sources =
        json::array({instance.node, attributes, JsonMember(primitive, "targets"), uv.set,
                     uv.offset.x, uv.offset.y, uv.scale.x, uv.scale.y, uv.rotation_rad});
    const auto [known, fresh] = runs_.try_emplace(sources.dump());
    if (fresh) known->second = ReadVertices(primitive, instance, uv, names);
    ImportedHead::Part part;
    part.name = name;
    part.indices = TrianglesOf(primitive, instance, known->second);
    if (triangles_ += part.indices.size() / 3; triangles_ > kMaxMeshTriangles) RefuseSize();
    textures_.ApplyMaterial(JsonInteger(primitive, "material"), part);
    if (!part.indices.empty()) head_.parts.push_back(std::move(part));
  }

  /// The vertices of the head made from one set of attributes under one node.
  struct VertexRun {
    std::size_t first = 0, count = 0;
    bool mirrored = false;  // the node's matrix mirrors, which reverses triangles
  };

  /// Returns the triangles of a primitive, counter-clockwise from outside.
  std::vector<std::uint32_t> TrianglesOf(const json& primitive, const GltfMeshInstance& instance,
                                         const VertexRun& run) const {
    std::vector<std::uint32_t> indices(run.count);
    std::iota(indices.begin(), indices.end(), 0u);
    if (primitive.contains("indices")) {
      indices = document_.Indices(JsonInteger(primitive, "indices"));
    }
    for (std::uint32_t& i : indices) {
      if (i >= run.count) {
        RefuseFile("meshes[" + std::to_string(instance.mesh) + "]: an index beyond its " +
                   std::to_string(run.count) + " vertices");
      }
      i += static_cast<std::uint32_t>(run.first);
    }
    indices.resize(indices.size() / 3 * 3);
    if (run.mirrored) {
      for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
    }
    return indices;
  }

  VertexRun ReadVertices(const json& primitive, const GltfMeshInstance& instance,
                         const GltfUvTransform& uv, const std::vector<std::string>& names) {
    const json& attributes = JsonMember(primitive, "attributes");
    const std::int64_t position = JsonInteger(attributes, "POSITION");
    const std::size_t first = head_.position.size();
    const auto numbers = document_.Numbers(position, 3);
    const std::size_t count = numbers.size() / 3;
    if (first + count > kMaxMeshVertices) RefuseSize();
    std::vector<glm::mat4> transforms(count, nodes_.World(instance.node));
    std::vector<GltfSkin::Skinned::Influence> watched;
    head_.eye.resize(first);
    if (instance.skin >= 0) {
      GltfSkin::Skinned skinned =
          skins_.at(instance.skin)
              .Apply(document_, attributes, count, nodes_.World(instance.node),
                     [this](std::int64_t bone) { return springs_.Has(bone); });
      transforms = std::move(skinned.transform);
      watched = std::move(skinned.watched);
      std::ranges::transform(skinned.main, std::back_inserter(head_.eye),
                             [this](std::int64_t bone) { return EyeOfBone(bone); });
    }
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec4 p(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2], 1);
      head_.position.push_back(glm::vec3(transforms[i] * p));
      if (!WithinReach(head_.position.back())) RefuseReach(VertexName(instance, i));
    }
    for (const auto& [vertex, node, weight] : watched) {
      springs_.Bind(static_cast<std::uint32_t>(first + vertex), head_.position[first + vertex],
                    node, weight, head_.spring_rig.weights);
    }
    ReadTexcoords(attributes, uv, first);
    if (attributes.contains("COLOR_0"))
      ReadVertexColours(JsonInteger(attributes, "COLOR_0"), first, count);
    targets_.Read(primitive, instance, transforms, first, names);
    return {first, count, count > 0 && glm::determinant(glm::mat3(transforms[0])) < 0};
  }

  /// Returns the eye that a bone belongs to.
  std::optional<Side> EyeOfBone(std::int64_t bone) const {
    if (bone < 0) return std::nullopt;
    const auto is = [this, bone](Side side) { return bone == avatar_.eye_bone[side]; };
    const auto found = std::ranges::find_if(kSides, is);
    return found == kSides.end() ? std::nullopt : std::optional(*found);
  }

  void ReadTexcoords(const json& attributes, const GltfUvTransform& to, std::size_t first) {
    const std::string set = "TEXCOORD_" + std::to_string(to.set);
    if (!attributes.contains(set)) return;
    const auto uv = document_.Numbers(JsonInteger(attributes, set.c_str()), 2);
    head_.texcoord.resize(head_.position.size(), glm::vec2(0));
    for (std::size_t i = 0; i < std::min(head_.position.size() - first, uv.size() / 2); ++i) {
      // A transform may overflow what the file's numbers do not.
      const glm::vec2 at = to({uv[2 * i], uv[2 * i + 1]});
      head_.texcoord[first + i] = WithinReach(glm::vec3(at, 0)) ? at : glm::vec2(0);
    }
  }

  void ReadVertexColours(std::int64_t accessor, std::size_t begin, std::size_t count) {
    const std::size_t width =
        JsonText(document_.At("accessors", accessor), "type") == "VEC4" ? 4 : 3;
    const auto colours = document_.Numbers(accessor, static_cast<int>(width));
    head_.vertex_colour.resize(head_.position.size(), glm::vec3(1));
    for (std::size_t i = 0; i < std::min(count, colours.size() / width); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        head_.vertex_colour[begin + i][static_cast<int>(c)] =
            std::clamp(colours[width * i + c], 0.0f, 1.0f);
      }
    }
  }

  void TurnAround() {
    const glm::vec3 round(-1, 1, -1);
    for (glm::vec3& p : head_.position) p *= round;
    if (head_.eye_rig.pivot) {
      for (const Side side : kSides) (*head_.eye_rig.pivot)[side] *= round;
    }
    for (Spring& spring : head_.spring_rig.springs) {
      spring.rest *= round;
      spring.root *= round;
    }
    for (auto& shape : head_.shapes) {
      for (Displacement& move : shape.moves) move.offset *= round;
    }
  }

  // Each is made from those before it.
  const GltfDocument document_;
  ImportedHead head_;
  const VrmAvatar avatar_;
  const GltfNodes nodes_;
  const VrmSprings springs_;
  GltfTextures textures_;
  GltfTargets targets_;
  std::map<std::int64_t, GltfSkin> skins_;
  std::map<std::string, VertexRun> runs_;  // by node, accessors and texture coordinates, as JSON
  std::size_t triangles_ = 0;
};

vm::Result<ImportedHead> ReadDocument(const std::string& name, std::string_view bytes,
                                      const GltfDocument::Beside& beside) try {
  return AtPlace(name, [&] { return GltfReader(name, bytes, beside).Read(); });
} catch (const vm::Failure& failure) {
  return std::unexpected(failure.error);
}

}  // namespace

vm::Result<ImportedHead> ParseGltfHead(const std::string& name, std::string_view bytes) {
  return ReadDocument(name, bytes, {});
}

vm::Result<ImportedHead> ReadGltfHead(const std::string& path) {
  const auto bytes = vm::ReadTextFile(path, kMaxMeshBytes);
  if (!bytes) return std::unexpected(bytes.error());
  std::vector<std::string> asked;
  const auto beside = [&](const std::string& uri) -> std::optional<std::string> {
    const auto file = FileBeside(path, uri);
    if (!file || uri.find(':') != std::string::npos) return std::nullopt;
    asked.push_back(*file);
    auto read = vm::ReadTextFile(*file, kMaxMeshBytes);
    if (!read) return std::nullopt;
    return std::move(*read);
  };
  auto file = ReadDocument(path, *bytes, beside);
  if (file) file->named_files = std::move(asked);
  return file;
}

}  // namespace fsm
