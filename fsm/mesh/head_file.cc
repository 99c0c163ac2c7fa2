#include "fsm/mesh/head_file.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "fsm/image/image_file.h"
#include "fsm/mesh/gltf_head.h"
#include "fsm/mesh/obj_file.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

glm::vec3 Linear(glm::vec3 screen) {
  return screen * (screen * (screen * 0.305306f + 0.682171f) + 0.012523f);
}

}  // namespace

std::optional<std::string> FileBeside(const std::string& path, const std::string& name) {
  const std::filesystem::path given(name);
  if (name.empty() || given.is_absolute() || std::ranges::find(given, "..") != given.end()) {
    return std::nullopt;
  }
  return (std::filesystem::path(path).parent_path() / given).string();
}

std::string PlainShapeName(std::string_view name) {
  std::string out = vm::LowerCase(name);
  if (const auto dot = out.find_last_of(".:"); dot != std::string::npos && dot + 2 < out.size()) {
    out = out.substr(dot + 1);  // node.shape, namespace:shape
  }
  for (const auto& [end, word] : {std::pair("_l", "left"), std::pair("_r", "right")}) {
    if (out.ends_with(end)) out = out.substr(0, out.size() - 2) + word;
  }
  std::erase_if(out, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return out;
}

namespace {

/// Makes a head of an .obj file and what lies beside it.
class ObjHead {
 public:
  ObjHead(const std::string& path, const ObjFile& obj) : path_(path), obj_(obj) {
    head_.name = path;
  }

  HeadFile Make() {
    ReadMaterials();
    for (const auto& group : obj_.groups) AddPart(group);
    return std::move(head_);
  }

 private:
  void ReadMaterials() {
    for (const std::string& library : obj_.libraries) {
      const auto beside = FileBeside(path_, library);
      if (!beside) continue;
      head_.named_files.push_back(*beside);
      // A head without its library still has its form.
      if (const auto text = vm::ReadTextFile(*beside, 1U << 22)) materials_.merge(ParseMtl(*text));
    }
  }

  void AddPart(const ObjFile::Group& group) {
    HeadFile::Part part;
    part.name = vm::LowerCase(group.name + " " + group.material);
    if (const auto found = materials_.find(group.material); found != materials_.end()) {
      part.colour = Linear(found->second.colour);
      const auto file = FileBeside(path_, found->second.picture);
      if (file && HasTexcoords()) part.picture = PictureOf(*file);
    }
    for (const auto& triangle : group.triangles) {
      for (const auto& corner : triangle) part.indices.push_back(VertexOf(corner));
    }
    head_.parts.push_back(std::move(part));
  }

  bool HasTexcoords() const { return !obj_.texcoords.empty(); }

  /// The picture's index; -1 if it cannot be read or is one too many.
  int PictureOf(const std::string& file) {
    constexpr std::size_t kMostPictures = 64;
    const auto [known, fresh] = pictures_.try_emplace(file, -1);
    if (fresh && pictures_.size() <= kMostPictures) {
      head_.named_files.push_back(file);
      if (auto picture = ReadImage(file)) {
        known->second = static_cast<int>(head_.pictures.size());
        head_.pictures.push_back(std::move(*picture));
      }
    }
    return known->second;
  }

  std::uint32_t VertexOf(const ObjFile::Corner& corner) {
    const bool textured = HasTexcoords() && corner.texcoord != ObjFile::kNone;
    const auto [found, fresh] =
        vertices_.try_emplace({corner.position, textured ? corner.texcoord : ObjFile::kNone},
                              static_cast<std::uint32_t>(head_.position.size()));
    if (fresh) {
      head_.position.push_back(obj_.positions[corner.position]);
      if (HasTexcoords()) {
        const glm::vec2 at = textured ? obj_.texcoords[corner.texcoord] : glm::vec2(0);
        head_.texcoord.emplace_back(at.x, 1 - at.y);
      }
    }
    return found->second;
  }

  const std::string& path_;
  const ObjFile& obj_;
  HeadFile head_;
  std::map<std::string, ObjMaterial> materials_;
  std::map<std::string, int> pictures_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertices_;  // by corner
};

}  // namespace

vm::Result<HeadFile> ReadHeadFile(const std::string& path) {
  const std::string ending = vm::LowerCase(std::filesystem::path(path).extension().string());
  if (ending == ".obj") {
    const auto obj = ReadObj(path);
    if (!obj) return std::unexpected(obj.error());
    return ObjHead(path, *obj).Make();
  }
  if (ending == ".glb" || ending == ".gltf" || ending == ".vrm") return ReadGltfHead(path);
  return vm::Fail(vm::Errc::kBadValue,
                  "'" + path + "' is no head's name: it must end in .obj, .glb, .gltf or .vrm");
}

}  // namespace fsm
