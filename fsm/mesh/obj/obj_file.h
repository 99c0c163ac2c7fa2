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

/// A Wavefront file: polygons by group and material, cut into triangles.
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
  std::vector<glm::vec2> texcoords;  ///< texture coordinates, v up
  std::vector<Group> groups;         ///< each name and material once, empty ones left out
  std::vector<std::string> libraries;
};

/// A surface of an .mtl file.
struct ObjMaterial {
  glm::vec3 colour{0.8f};  ///< screen colour, 0..1
  std::string picture;     ///< "" = none
};

inline constexpr std::size_t kMaxMeshVertices = 400000;
inline constexpr std::size_t kMaxMeshTriangles = 800000;
inline constexpr std::size_t kMaxMeshBytes = 200U << 20;

/// Reads `v`, `vt` (and the original's `tv`), `f`, `g`, `o`, `usemtl` and `mtllib`; other lines
/// mean nothing here. Errors: kBadValue "NAME:LINE: what was expected", kLimit.
vm::Result<ObjFile> ParseObj(const std::string& name, std::string_view text);
vm::Result<ObjFile> ReadObj(const std::string& path);
/// `newmtl`, `Kd` and `map_Kd` of an .mtl file, by name. Damaged numbers leave the colour.
std::map<std::string, ObjMaterial> ParseMtl(std::string_view text);

}  // namespace fsm
