#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "fsm/mesh/gltf_document.h"
#include "fsm/mesh/head_file.h"
#include "fsm/mesh/obj_file.h"
#include "fsm/mesh/pnt_file.h"
#include "fsm/render/image_codec.h"

namespace fsm {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxShapes = 400;
constexpr std::size_t kMaxDeltas = 20'000'000;
constexpr std::size_t kMaxPictures = 64;

glm::mat4 MatrixOf(const json& node) {
  const json& given = PartOf(node, "matrix");
  glm::mat4 m(1.0f);
  if (given.is_array() && given.size() == 16) {
    for (std::size_t i = 0; i < 16; ++i) {
      if (given[i].is_number())
        m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = given[i].get<float>();
    }
    return m;
  }
  const auto numbers = [&node](const char* key, glm::vec4 otherwise, std::size_t count) {
    const json& list = PartOf(node, key);
    if (!list.is_array() || list.size() != count) return otherwise;
    for (std::size_t i = 0; i < count; ++i) {
      if (list[i].is_number()) otherwise[static_cast<int>(i)] = list[i].get<float>();
    }
    return otherwise;
  };
  const glm::vec4 move = numbers("translation", glm::vec4(0), 3),
                  size = numbers("scale", glm::vec4(1), 3),
                  q = numbers("rotation", {0, 0, 0, 1}, 4);
  m = glm::mat4_cast(glm::quat(q.w, q.x, q.y, q.z));
  for (int c = 0; c < 3; ++c) m[c] *= size[c];
  m[3] = glm::vec4(glm::vec3(move), 1);
  return m;
}

std::string Small(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

class GltfReader {
 public:
  explicit GltfReader(GltfDocument document) : document_(std::move(document)) {}

  vm::Result<HeadFile> Read() {
    head_.metres = true;
    FindEyeBones();
    std::set<std::int64_t> roots;
    for (std::size_t i = 0; i < document_.Count("nodes"); ++i)
      roots.insert(static_cast<std::int64_t>(i));
    for (std::size_t i = 0; i < document_.Count("nodes"); ++i) {
      const json& children =
          PartOf(document_.At("nodes", static_cast<std::int64_t>(i)), "children");
      for (const json& child : children) {
        if (child.is_number_integer()) roots.erase(child.get<std::int64_t>());
      }
    }
    for (const std::int64_t root : roots) {
      if (auto read = Node(root, glm::mat4(1.0f), 0); !read) return std::unexpected(read.error());
    }
    if (head_.parts.empty()) return document_.Wrong("no mesh of triangles is in it");
    Expressions();
    // Avatars of VRM 0 look the other way (VRM 0.0 specification, "facing -Z").
    if (PartOf(document_.root(), "extensions").contains("VRM")) TurnRound();
    if (!head_.place.empty()) head_.place.resize(head_.position.size(), glm::vec2(0));
    if (!head_.tint.empty()) head_.tint.resize(head_.position.size(), glm::vec3(1));
    if (head_.eye.size() < head_.position.size()) head_.eye.resize(head_.position.size(), 0);
    if (std::ranges::all_of(head_.eye, [](std::int8_t e) { return e == 0; })) head_.eye.clear();
    return std::move(head_);
  }

 private:
  void FindEyeBones() {
    const json& extensions = PartOf(document_.root(), "extensions");
    const json& humanoid = PartOf(PartOf(extensions, "VRM"), "humanoid");
    for (const json& bone : PartOf(humanoid, "humanBones")) {
      const std::string name = TextOf(bone, "bone");
      if (name == "rightEye") eye_bone_[0] = WholeOf(bone, "node");
      if (name == "leftEye") eye_bone_[1] = WholeOf(bone, "node");
    }
    const json& bones = PartOf(PartOf(PartOf(extensions, "VRMC_vrm"), "humanoid"), "humanBones");
    if (bones.is_object()) {
      if (bones.contains("rightEye")) eye_bone_[0] = WholeOf(bones["rightEye"], "node");
      if (bones.contains("leftEye")) eye_bone_[1] = WholeOf(bones["leftEye"], "node");
    }
  }

  vm::Result<void> Node(std::int64_t index, const glm::mat4& above, int depth) {
    if (depth > 200 || !seen_.insert(index).second) {
      return document_.Wrong("nodes[" + std::to_string(index) +
                             "]: nodes that are their own parents");
    }
    const json& node = document_.At("nodes", index);
    const glm::mat4 here = above * MatrixOf(node);
    if (const std::int64_t mesh = WholeOf(node, "mesh"); mesh >= 0) {
      // A skinned mesh is where its bones are; at rest that is where it was made.
      const bool skinned = WholeOf(node, "skin") >= 0;
      if (auto read = Mesh(mesh, index, skinned ? glm::mat4(1.0f) : here, WholeOf(node, "skin"),
                           TextOf(node, "name"));
          !read) {
        return read;
      }
    }
    for (const json& child : PartOf(node, "children")) {
      if (!child.is_number_integer()) continue;
      if (auto read = Node(child.get<std::int64_t>(), here, depth + 1); !read) return read;
    }
    return {};
  }

  vm::Result<void> Mesh(std::int64_t index, std::int64_t node, const glm::mat4& place,
                        std::int64_t skin, const std::string& node_name) {
    const json& mesh = document_.At("meshes", index);
    const json& primitives = PartOf(mesh, "primitives");
    std::vector<std::string> names;
    for (const json& name : PartOf(PartOf(mesh, "extras"), "targetNames")) {
      names.push_back(name.is_string() ? name.get<std::string>() : "");
    }
    for (const json& primitive : primitives) {
      if (WholeOf(primitive, "mode", 4) != 4) continue;
      auto read = Primitive(primitive, index, node, place, skin,
                            Small(node_name + " " + TextOf(mesh, "name")), names);
      if (!read) return read;
    }
    return {};
  }

  vm::Result<void> Primitive(const json& primitive, std::int64_t mesh, std::int64_t node,
                             const glm::mat4& place, std::int64_t skin, const std::string& name,
                             const std::vector<std::string>& names) {
    const json& attributes = PartOf(primitive, "attributes");
    const std::int64_t position = WholeOf(attributes, "POSITION");
    // Primitives of a mesh often share their vertices.
    const auto [known, fresh] = first_of_.try_emplace({node, position}, head_.position.size());
    const std::size_t first = known->second;
    std::size_t count = 0;
    {
      const auto numbers = document_.Numbers(position, 3);
      if (!numbers) return std::unexpected(numbers.error());
      count = numbers->size() / 3;
      if (fresh) {
        if (head_.position.size() + count > kMaxMeshVertices) return TooMany();
        for (std::size_t i = 0; i < count; ++i) {
          const glm::vec4 p((*numbers)[3 * i], (*numbers)[3 * i + 1], (*numbers)[3 * i + 2], 1);
          head_.position.push_back(glm::vec3(place * p));
        }
        if (auto read = Vertices(attributes, count, skin); !read) return read;
        if (auto read = Targets(primitive, mesh, node, place, first, count, names); !read)
          return read;
      }
    }
    HeadFile::Part part;
    part.name = name;
    if (primitive.contains("indices")) {
      const auto indices = document_.Indices(WholeOf(primitive, "indices"));
      if (!indices) return std::unexpected(indices.error());
      for (const std::uint32_t i : *indices) {
        if (i >= count) {
          return document_.Wrong("meshes[" + std::to_string(mesh) + "]: an index beyond its " +
                                 std::to_string(count) + " vertices");
        }
        part.indices.push_back(static_cast<std::uint32_t>(first) + i);
      }
    } else {
      for (std::size_t i = 0; i < count; ++i)
        part.indices.push_back(static_cast<std::uint32_t>(first + i));
    }
    part.indices.resize(part.indices.size() / 3 * 3);
    if (triangles_ += part.indices.size() / 3; triangles_ > kMaxMeshTriangles) return TooMany();
    MaterialOf(WholeOf(primitive, "material"), part);
    if (!part.indices.empty()) head_.parts.push_back(std::move(part));
    return {};
  }

  vm::Result<void> Vertices(const json& attributes, std::size_t count, std::int64_t skin) {
    const auto begin = head_.position.size() - count;
    head_.eye.resize(head_.position.size(), 0);
    if (attributes.contains("TEXCOORD_0")) {
      const auto uv = document_.Numbers(WholeOf(attributes, "TEXCOORD_0"), 2);
      if (!uv) return std::unexpected(uv.error());
      head_.place.resize(head_.position.size(), glm::vec2(0));
      for (std::size_t i = 0; i < std::min(count, uv->size() / 2); ++i) {
        head_.place[begin + i] = {(*uv)[2 * i], (*uv)[2 * i + 1]};
      }
    }
    if (attributes.contains("COLOR_0")) {
      if (auto read = Tints(WholeOf(attributes, "COLOR_0"), begin, count); !read) return read;
    }
    if (skin < 0 || !attributes.contains("JOINTS_0") || !attributes.contains("WEIGHTS_0") ||
        (eye_bone_[0] < 0 && eye_bone_[1] < 0)) {
      return {};
    }
    const json& joints = PartOf(document_.At("skins", skin), "joints");
    const auto which = document_.Numbers(WholeOf(attributes, "JOINTS_0"), 4);
    const auto weights = document_.Numbers(WholeOf(attributes, "WEIGHTS_0"), 4);
    if (!which) return std::unexpected(which.error());
    if (!weights) return std::unexpected(weights.error());
    for (std::size_t i = 0; i < std::min({4 * count, which->size(), weights->size()}); ++i) {
      const auto joint = static_cast<std::size_t>((*which)[i]);
      if ((*weights)[i] < 0.5f || joint >= joints.size() || !joints[joint].is_number_integer())
        continue;
      const auto bone = joints[joint].get<std::int64_t>();
      if (bone == eye_bone_[0]) head_.eye[begin + i / 4] = 1;
      if (bone == eye_bone_[1]) head_.eye[begin + i / 4] = 2;
    }
    return {};
  }

  vm::Result<void> Tints(std::int64_t accessor, std::size_t begin, std::size_t count) {
    const std::size_t width = TextOf(document_.At("accessors", accessor), "type") == "VEC4" ? 4 : 3;
    const auto colours = document_.Numbers(accessor, static_cast<int>(width));
    if (!colours) return std::unexpected(colours.error());
    head_.tint.resize(head_.position.size(), glm::vec3(1));
    for (std::size_t i = 0; i < std::min(count, colours->size() / width); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        head_.tint[begin + i][static_cast<int>(c)] =
            std::clamp((*colours)[width * i + c], 0.0f, 1.0f);
      }
    }
    return {};
  }

  vm::Result<void> Targets(const json& primitive, std::int64_t mesh, std::int64_t node,
                           const glm::mat4& place, std::size_t first, std::size_t count,
                           const std::vector<std::string>& names) {
    const json& targets = PartOf(primitive, "targets");
    for (std::size_t t = 0; t < targets.size(); ++t) {
      if (!targets.is_array() || !targets[t].contains("POSITION")) continue;
      const auto by = document_.Numbers(WholeOf(targets[t], "POSITION"), 3);
      if (!by) return std::unexpected(by.error());
      if (by->size() < 3 * count) {
        return document_.Wrong("meshes[" + std::to_string(mesh) + "]: target " + std::to_string(t) +
                               " has fewer vertices than the mesh");
      }
      const std::string name = t < names.size() ? names[t] : "target" + std::to_string(t);
      const auto [known, fresh] = shape_of_.try_emplace(name, head_.shapes.size());
      if (fresh) {
        if (head_.shapes.size() >= kMaxShapes) return TooMany();
        head_.shapes.push_back({name, {}});
      }
      auto& deltas = head_.shapes[known->second].deltas;
      targets_[{mesh, t}].push_back({known->second, node});
      for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 d((*by)[3 * i], (*by)[3 * i + 1], (*by)[3 * i + 2]);
        if (d == glm::vec3(0)) continue;
        deltas.push_back(
            {static_cast<std::uint32_t>(first + i), glm::vec3(place * glm::vec4(d, 0))});
        if (++deltas_ > kMaxDeltas) return TooMany();
      }
    }
    return {};
  }

  void MaterialOf(std::int64_t index, HeadFile::Part& part) {
    const json& material = document_.At("materials", index);
    part.name += " " + Small(TextOf(material, "name"));
    const json& rough = PartOf(material, "pbrMetallicRoughness");
    const json& factor = PartOf(rough, "baseColorFactor");
    if (index >= 0) part.colour = glm::vec3(1);
    for (std::size_t k = 0; k < 3 && factor.is_array() && k < factor.size(); ++k) {
      if (factor[k].is_number())
        part.colour[static_cast<int>(k)] = std::clamp(factor[k].get<float>(), 0.0f, 1.0f);
    }
    const std::string mode = TextOf(material, "alphaMode");
    part.cut_out = mode == "MASK" || mode == "BLEND";
    part.two_sided = material.contains("doubleSided") && material["doubleSided"] == json(true);
    const std::int64_t texture = WholeOf(PartOf(rough, "baseColorTexture"), "index");
    if (texture < 0) return;
    const std::int64_t image = WholeOf(document_.At("textures", texture), "source");
    const auto [known, fresh] = picture_of_.try_emplace(image, -1);
    if (fresh && head_.pictures.size() < kMaxPictures) {
      // A picture that cannot be read leaves the colour; the form is still worth showing.
      const auto bytes = document_.ImageBytes(image);
      std::string why;
      std::optional<Image> picture;
      if (bytes) {
        picture =
            DecodePicture({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()}, why);
      }
      if (picture) {
        known->second = static_cast<int>(head_.pictures.size());
        head_.pictures.push_back(std::move(*picture));
      }
    }
    part.picture = known->second;
  }

  /// VRM's expressions become shapes of their own, called vrmNAME.
  void Expressions() {
    const json& extensions = PartOf(document_.root(), "extensions");
    for (const json& group :
         PartOf(PartOf(PartOf(extensions, "VRM"), "blendShapeMaster"), "blendShapeGroups")) {
      std::string name = TextOf(group, "presetName");
      if (name.empty() || name == "unknown") name = TextOf(group, "name");
      HeadFile::Shape shape{"vrm" + name, {}};
      for (const json& bind : PartOf(group, "binds")) {
        Add(shape, WholeOf(bind, "mesh"), -1, WholeOf(bind, "index"),
            RealOf(bind, "weight", 0) / 100);
      }
      Keep(std::move(shape));
    }
    const json& preset = PartOf(PartOf(PartOf(extensions, "VRMC_vrm"), "expressions"), "preset");
    if (!preset.is_object()) return;
    for (const auto& [name, expression] : preset.items()) {
      HeadFile::Shape shape{"vrm" + name, {}};
      for (const json& bind : PartOf(expression, "morphTargetBinds")) {
        const std::int64_t node = WholeOf(bind, "node");
        Add(shape, WholeOf(document_.At("nodes", node), "mesh"), node, WholeOf(bind, "index"),
            RealOf(bind, "weight", 0));
      }
      Keep(std::move(shape));
    }
  }

  void Add(HeadFile::Shape& shape, std::int64_t mesh, std::int64_t node, std::int64_t target,
           double weight) {
    const auto found =
        targets_.find({mesh, static_cast<std::size_t>(std::max<std::int64_t>(target, 0))});
    if (found == targets_.end() || target < 0) return;
    std::set<std::size_t> once;
    for (const auto& [index, of] : found->second) {
      if ((node >= 0 && of != node) || !once.insert(index).second) continue;
      for (const auto& delta : head_.shapes[index].deltas) {
        if (++deltas_ > kMaxDeltas) return;
        shape.deltas.push_back({delta.vertex, static_cast<float>(weight) * delta.by});
      }
    }
  }

  void Keep(HeadFile::Shape shape) {
    if (!shape.deltas.empty() && head_.shapes.size() < kMaxShapes)
      head_.shapes.push_back(std::move(shape));
  }

  void TurnRound() {
    const glm::vec3 round(-1, 1, -1);
    for (glm::vec3& p : head_.position) p *= round;
    for (auto& shape : head_.shapes) {
      for (auto& delta : shape.deltas) delta.by *= round;
    }
  }

  std::unexpected<vm::Error> TooMany() const {
    return vm::Fail(vm::Errc::kLimit, document_.Wrong("").error().text + "at most " +
                                          std::to_string(kMaxMeshVertices) + " vertices, " +
                                          std::to_string(kMaxMeshTriangles) + " triangles and " +
                                          std::to_string(kMaxShapes) + " shapes are read");
  }

  GltfDocument document_;
  HeadFile head_;
  std::array<std::int64_t, 2> eye_bone_{-1, -1};
  std::set<std::int64_t> seen_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> first_of_;
  std::map<std::string, std::size_t> shape_of_;
  std::map<std::pair<std::int64_t, std::size_t>, std::vector<std::pair<std::size_t, std::int64_t>>>
      targets_;
  std::map<std::int64_t, int> picture_of_;
  std::size_t triangles_ = 0, deltas_ = 0;
};

vm::Result<HeadFile> ReadDocument(vm::Result<GltfDocument> document) {
  if (!document) return std::unexpected(document.error());
  return GltfReader(std::move(*document)).Read();
}

}  // namespace

vm::Result<HeadFile> ParseGltfHead(const std::string& name, std::string_view bytes) {
  return ReadDocument(GltfDocument::Parse(name, bytes, {}));
}

vm::Result<HeadFile> ReadGltfHead(const std::string& path) {
  const auto bytes = ReadWhole(path, kMaxMeshBytes);
  if (!bytes) return std::unexpected(bytes.error());
  const auto beside = [&path](const std::string& uri) -> std::optional<std::string> {
    const std::filesystem::path given(uri);
    if (given.is_absolute() || uri.find(':') != std::string::npos) return std::nullopt;
    for (const auto& step : given) {
      if (step == "..") return std::nullopt;
    }
    auto read =
        ReadWhole((std::filesystem::path(path).parent_path() / given).string(), kMaxMeshBytes);
    if (!read) return std::nullopt;
    return std::move(*read);
  };
  return ReadDocument(GltfDocument::Parse(path, *bytes, beside));
}

}  // namespace fsm
