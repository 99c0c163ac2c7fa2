#pragma once

#include <string>
#include <string_view>

#include "hypermask/geometry/plane_map.h"
#include "vm_protocol/core/result.h"

namespace hypermask {

/// What the mask is like: mm from its middle in its plane, x right and y down as the camera sees
/// it.
struct MaskLayout {
  static constexpr std::size_t kLeastMarkers = 4, kMostMarkers = 12;

  Points markers{};     ///< the first four: the corners, clockwise from the upper left
  Point oval{95, 130};  ///< half the width and height of what the face is projected into
  Point picture{0, 8};  ///< where the middle of the face's picture lies
  double picture_height = 420;

  /// The built-in one: tables/mask.txt.
  static const MaskLayout& Default();
};

/// Reads a file of that form. Errors: those of vm::ReadTextFile; kBadValue as ReadKeyLines, also if
/// the corners are not convex, or markers lie outside of +-2000 mm or within 10 mm of each other.
vm::Result<MaskLayout> ReadMaskLayout(const std::string& path);
vm::Result<MaskLayout> ParseMaskLayout(const std::string& name, std::string_view text);

}  // namespace hypermask
