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
/// "point 12 of group 4", for messages.
std::string InWords(const PointName& point);

/// The original's wireframe, or offsets over one: places by name, in the order of the file.
struct PntFile {
  std::vector<PointName> names;
  std::vector<glm::vec3> at;
  std::map<PointName, std::size_t> index;  ///< of a name in both
};

/// The wireframe's triangles, each in a group of its own.
struct LnkFile {
  struct Triangle {
    int group;
    std::array<PointName, 3> corner;
  };
  std::vector<Triangle> triangles;
};

inline constexpr std::size_t kMaxWireframe = 20000;    ///< points, and triangles
inline constexpr std::size_t kMaxPntBytes = 4U << 20;  ///< of a file

/// A .pnt file: `#N`, then N - 1 lines `INDEX GROUP NUMBER X Y Z`. Errors: kBadValue "NAME:LINE:
/// what was expected", kLimit.
vm::Result<PntFile> ParsePnt(const std::string& name, std::string_view text);
/// A .lnk file: `#N`, then N - 1 lines `INDEX GROUP NUMBER` and three times `GROUP NUMBER`.
vm::Result<LnkFile> ParseLnk(const std::string& name, std::string_view text);

/// Both from a file. Errors: also those of vm::ReadTextFile.
vm::Result<PntFile> ReadPnt(const std::string& path);
vm::Result<LnkFile> ReadLnk(const std::string& path);

}  // namespace fsm
