#include "fsm/mesh/obj/obj_file.h"

#include <cmath>
#include <span>

#include "fsm/base/parse_number.h"
#include "fsm/base/words.h"
#include "fsm/mesh/mesh_limits.h"
#include "fsm/rig/reach.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxCorners = 64;

/// Parses the numbers after a line's first word. Returns false if they are too few or malformed.
bool ReadReals(const std::vector<std::string_view>& words, std::span<float> out) {
  if (words.size() <= out.size()) return false;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto number = ParseNumber<float>(words[i + 1]);
    if (!number || std::abs(*number) > kMaxReach) return false;
    out[i] = *number;
  }
  return true;
}

/// Parses an index counted from 1, or from -1 backwards; returns kNone if it is out of range.
std::uint32_t Index(std::string_view word, std::size_t count) {
  const auto value = ParseNumber<long>(word);
  if (!value) return ObjFile::kNone;
  const long at = *value < 0 ? static_cast<long>(count) + *value : *value - 1;
  return at >= 0 && static_cast<std::size_t>(at) < count ? static_cast<std::uint32_t>(at)
                                                         : ObjFile::kNone;
}

class ObjReader {
 public:
  ObjReader(const std::string& name, std::string_view text) : name_(name), text_(text) {}

  vm::Result<ObjFile> Read() {
    while (!text_.empty()) {
      const auto words = WordsOf(ReadUntil("\n", text_), kMaxCorners + 2);
      ++line_;
      if (words.empty()) continue;
      if (auto read = Line(words); !read) return std::unexpected(read.error());
    }
    std::erase_if(file_.groups, [](const auto& group) { return group.triangles.empty(); });
    if (file_.groups.empty()) {
      return vm::Fail(vm::Errc::kBadValue, name_ + ": no faces (lines f) are in it");
    }
    return std::move(file_);
  }

 private:
  std::unexpected<vm::Error> Fail(const std::string& text) const {
    return vm::Fail(vm::Errc::kBadValue, name_ + ":" + std::to_string(line_) + ": " + text);
  }

  vm::Result<void> Line(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    if (key == "v") {
      glm::vec3 p;
      if (!ReadReals(words, std::span(&p.x, 3))) return Fail("v X Y Z expected");
      file_.positions.push_back(p);
      if (file_.positions.size() > kMaxMeshVertices) return FailSize();
    } else if (key == "vt" || key == "tv") {
      glm::vec2 p;
      if (!ReadReals(words, std::span(&p.x, 2))) return Fail("vt U V expected");
      file_.texcoords.push_back(p);
      if (file_.texcoords.size() > kMaxMeshVertices) return FailSize();
    } else if (key == "f") {
      return Face(words);
    } else if (key == "g" || key == "o") {
      group_ = words.size() > 1 ? std::string(words[1]) : "";
      open_ = nullptr;
    } else if (key == "usemtl") {
      material_ = words.size() > 1 ? std::string(words[1]) : "";
      open_ = nullptr;
    } else if (key == "mtllib" && words.size() > 1) {
      file_.libraries.emplace_back(words[1]);
    }
    return {};
  }

  vm::Result<void> Face(const std::vector<std::string_view>& words) {
    if (words.size() < 4 || words.size() > kMaxCorners + 1) {
      return Fail("f with 3 to " + std::to_string(kMaxCorners) + " corners expected");
    }
    // The original's files of teeth end in faces of zeros, which refer to no vertices.
    if (words[1].substr(0, words[1].find('/')) == "0") return {};
    std::vector<ObjFile::Corner> corners;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::string_view word = words[i];
      const std::size_t slash = word.find('/');
      ObjFile::Corner corner{Index(word.substr(0, slash), file_.positions.size()), ObjFile::kNone};
      if (corner.position == ObjFile::kNone) {
        return Fail("corner '" + std::string(word.substr(0, 30)) + "' names none of the " +
                    std::to_string(file_.positions.size()) + " vertices so far");
      }
      if (slash != std::string_view::npos) {
        const std::string_view rest = word.substr(slash + 1);
        corner.texcoord = Index(rest.substr(0, rest.find('/')), file_.texcoords.size());
      }
      corners.push_back(corner);
    }
    if (triangles_ += corners.size() - 2; triangles_ > kMaxMeshTriangles) return FailSize();
    if (!open_) open_ = &Group();
    for (std::size_t k = 2; k < corners.size(); ++k) {
      open_->triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
    return {};
  }

  ObjFile::Group& Group() {
    const auto [found, fresh] = known_.try_emplace({group_, material_}, file_.groups.size());
    if (fresh) file_.groups.push_back({group_, material_, {}});
    return file_.groups[found->second];
  }

  std::unexpected<vm::Error> FailSize() const {
    return vm::Fail(vm::Errc::kLimit, name_ + ":" + std::to_string(line_) + ": at most " +
                                          std::to_string(kMaxMeshVertices) + " vertices and " +
                                          std::to_string(kMaxMeshTriangles) +
                                          " triangles are read");
  }

  const std::string& name_;
  std::string_view text_;
  ObjFile file_;
  std::string group_, material_;
  std::map<std::pair<std::string, std::string>, std::size_t> known_;
  ObjFile::Group* open_ = nullptr;  // valid until a group is added
  std::size_t triangles_ = 0;
  int line_ = 0;
};

}  // namespace

vm::Result<ObjFile> ParseObj(const std::string& name, std::string_view text) {
  return ObjReader(name, text).Read();
}

vm::Result<ObjFile> ReadObj(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxMeshBytes);
  if (!text) return std::unexpected(text.error());
  return ParseObj(path, *text);
}

std::map<std::string, ObjMaterial> ParseMtl(std::string_view text) {
  std::map<std::string, ObjMaterial> all;
  ObjMaterial* open = nullptr;
  while (!text.empty()) {
    const auto words = WordsOf(ReadUntil("\n", text), kMaxCorners + 2);
    if (words.size() < 2) continue;
    if (words[0] == "newmtl") {
      if (all.size() >= 1000) break;
      open = &all[std::string(words[1])];
    } else if (open && words[0] == "Kd") {
      glm::vec3 colour;
      if (ReadReals(words, std::span(&colour.x, 3))) open->colour = colour;
    } else if (open && words[0] == "map_Kd") {
      open->picture = std::string(words.back());
    }
  }
  return all;
}

}  // namespace fsm
