#include "fsm/mesh/obj/obj_head.h"

#include <map>

#include "fsm/image/colour_space.h"
#include "fsm/image/image_file.h"
#include "fsm/mesh/obj/obj_file.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

/// Makes a head from an .obj file, its materials and pictures.
class ObjHead {
 public:
  ObjHead(const std::string& path, const ObjFile& obj) : path_(path), obj_(obj) {
    head_.name = path;
  }

  ImportedHead Make() {
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
      // A head without its material library still has its shape.
      if (const auto text = vm::ReadTextFile(*beside, 1U << 22)) materials_.merge(ParseMtl(*text));
    }
  }

  void AddPart(const ObjFile::Group& group) {
    ImportedHead::Part part;
    part.name = group.name + " " + group.material;
    if (const auto found = materials_.find(group.material); found != materials_.end()) {
      part.colour = SrgbToLinear(found->second.colour);
      const auto file = FileBeside(path_, found->second.picture);
      if (file && HasTexcoords()) part.base_colour = PictureOf(*file);
    }
    for (const auto& triangle : group.triangles) {
      for (const auto& corner : triangle) part.indices.push_back(VertexOf(corner));
    }
    head_.parts.push_back(std::move(part));
  }

  bool HasTexcoords() const { return !obj_.texcoords.empty(); }

  /// Returns the picture's index; -1 if it cannot be read or there are too many.
  int PictureOf(const std::string& file) {
    constexpr std::size_t kMaxMtlPictures = 64;
    const auto [known, fresh] = pictures_.try_emplace(file, -1);
    if (fresh && pictures_.size() <= kMaxMtlPictures) {
      head_.named_files.push_back(file);
      if (auto picture = ReadImage(file)) {
        known->second = static_cast<int>(head_.base_colours.size());
        head_.base_colours.push_back(std::move(*picture));
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
  ImportedHead head_;
  std::map<std::string, ObjMaterial> materials_;
  std::map<std::string, int> pictures_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertices_;  // by corner
};

}  // namespace

vm::Result<ImportedHead> ReadObjHead(const std::string& path) {
  const auto obj = ReadObj(path);
  if (!obj) return std::unexpected(obj.error());
  return ObjHead(path, *obj).Make();
}

}  // namespace fsm
