#include "fsm/mesh/head_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "fsm/image/image_file.h"
#include "fsm/mesh/obj_file.h"
#include "fsm/mesh/pnt_file.h"
#include "vm_protocol/core/lower_case.h"

namespace fsm {
namespace {

/// A file beside `path`; nothing if the name leads out of its folder.
std::optional<std::string> Beside(const std::string& path, const std::string& name) {
  const std::filesystem::path given(name);
  if (name.empty() || given.is_absolute()) return std::nullopt;
  for (const auto& step : given) {
    if (step == "..") return std::nullopt;
  }
  return (std::filesystem::path(path).parent_path() / given).string();
}

glm::vec3 Linear(glm::vec3 screen) {
  return screen * (screen * (screen * 0.305306f + 0.682171f) + 0.012523f);
}

}  // namespace

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

vm::Result<HeadFile> ReadHeadFile(const std::string& path) {
  const std::string ending = vm::LowerCase(std::filesystem::path(path).extension().string());
  if (ending == ".obj") return ReadObjHead(path);
  if (ending == ".glb" || ending == ".gltf" || ending == ".vrm") return ReadGltfHead(path);
  return vm::Fail(vm::Errc::kBadValue,
                  "'" + path + "' is no head's name: it must end in .obj, .glb, .gltf or .vrm");
}

vm::Result<HeadFile> ReadObjHead(const std::string& path) {
  const auto obj = ReadObj(path);
  if (!obj) return std::unexpected(obj.error());
  HeadFile head;
  head.name = path;
  std::map<std::string, ObjMaterial> materials;
  for (const std::string& library : obj->libraries) {
    const auto beside = Beside(path, library);
    if (beside) head.beside.push_back(*beside);
    const auto text = beside ? ReadWhole(*beside, 1U << 22)
                             : vm::Result<std::string>(vm::Fail(vm::Errc::kBadValue, ""));
    // A head without its library still has its form.
    if (text) materials.merge(ParseMtl(*text));
  }
  std::map<std::string, int> pictures;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;
  const bool placed = !obj->texcoords.empty();
  for (const auto& group : obj->groups) {
    HeadFile::Part part;
    part.name = vm::LowerCase(group.name + " " + group.material);
    if (const auto found = materials.find(group.material); found != materials.end()) {
      part.colour = Linear(found->second.colour);
      const auto file = Beside(path, found->second.picture);
      if (file && placed) {
        const auto [known, fresh] = pictures.try_emplace(*file, -1);
        if (fresh && pictures.size() <= 64) {
          head.beside.push_back(*file);
          if (auto picture = ReadImage(*file)) {
            known->second = static_cast<int>(head.pictures.size());
            head.pictures.push_back(std::move(*picture));
          }
        }
        part.picture = known->second;
      }
    }
    for (const auto& t : group.triangles) {
      for (const auto& corner : t) {
        const auto [found, fresh] =
            made.try_emplace({corner.position, placed ? corner.texcoord : ObjFile::kNone},
                             static_cast<std::uint32_t>(head.position.size()));
        if (fresh) {
          head.position.push_back(obj->positions[corner.position]);
          if (placed) {
            const glm::vec2 at =
                corner.texcoord == ObjFile::kNone ? glm::vec2(0) : obj->texcoords[corner.texcoord];
            head.texcoord.emplace_back(at.x, 1 - at.y);
          }
        }
        part.indices.push_back(found->second);
      }
    }
    head.parts.push_back(std::move(part));
  }
  return head;
}

}  // namespace fsm
