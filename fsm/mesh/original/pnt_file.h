#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// A vertex of the original's wireframe is named by its group (a part of the face) and its number
/// in the group.
using PointName = std::pair<int, int>;
/// Returns "point 12 of group 4", for messages.
std::string InWords(const PointName& point);

/// A wireframe of the original, or offsets from one: positions by name, in the order of the file.
struct PntFile {
  std::vector<PointName> names;
  std::vector<glm::vec3> positions;
  std::map<PointName, std::size_t> index;  ///< index into `names` and `positions`
};

/// The triangles of a wireframe, each with the number of its group.
struct LnkFile {
  struct Triangle {
    int group;
    std::array<PointName, 3> corner;
  };
  std::vector<Triangle> triangles;
};

inline constexpr std::size_t kMaxWireframe = 20000;    ///< points, and triangles
inline constexpr std::size_t kMaxPntBytes = 4U << 20;  ///< per file

/// Parses a .pnt file: `#N`, then N - 1 lines `INDEX GROUP NUMBER X Y Z`. Errors: kBadValue
/// "NAME:LINE: what was expected", kLimit.
vm::Result<PntFile> ParsePnt(const std::string& name, std::string_view text);
/// Parses a .lnk file: `#N`, then N - 1 lines `INDEX GROUP NUMBER` followed by three times `GROUP
/// NUMBER`. Errors: as ParsePnt.
vm::Result<LnkFile> ParseLnk(const std::string& name, std::string_view text);

/// Read such files. Errors: also those of vm::ReadTextFile.
vm::Result<PntFile> ReadPnt(const std::string& path);
vm::Result<LnkFile> ReadLnk(const std::string& path);

}  // namespace fsm
