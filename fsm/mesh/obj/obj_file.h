#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// A Wavefront .obj file: polygons by group and material, split into triangles.
struct ObjFile {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  struct Corner {
    std::uint32_t position, texcoord;  ///< into `positions` and `texcoords`, or kNone
  };
  struct Group {
    std::string name, material;
    std::vector<std::array<Corner, 3>> triangles;
  };
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> texcoords;  ///< v up
  std::vector<Group> groups;         ///< none empty, no two with the same name and material
  std::vector<std::string> libraries;
};

/// A material of an .mtl file.
struct ObjMaterial {
  glm::vec3 colour{0.8f};  ///< sRGB, 0..1
  std::string picture;     ///< "" = none
};

/// Reads `v`, `vt` (and the original's `tv`), `f`, `g`, `o`, `usemtl` and `mtllib`; ignores other
/// lines. Errors: kBadValue "NAME:LINE: what was expected", kLimit (mesh_limits.h).
vm::Result<ObjFile> ParseObj(const std::string& name, std::string_view text);
vm::Result<ObjFile> ReadObj(const std::string& path);
/// Reads `newmtl`, `Kd` and `map_Kd` of an .mtl file; returns materials by name. Malformed numbers
/// leave the default colour.
std::map<std::string, ObjMaterial> ParseMtl(std::string_view text);

}  // namespace fsm
