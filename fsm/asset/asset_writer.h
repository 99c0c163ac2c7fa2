#pragma once

#include <span>
#include <string>

#include "fsm/rig/head.h"

namespace fsm {

/// A morph target for other programs: its name, and the state that shows it at full strength.
struct ExportedShape {
  std::string name;
  FaceState state;
};

/// Writes a head as one file, binary glTF 2.0. Other programs see a mesh at rest that faces +z (the
/// node scales our millimetres to metres), with one primitive for each part, vertex colours or the
/// photo as texture, and each of `shapes` as a morph target named in extras.targetNames. ParseAsset
/// reads back exactly the written head from the extension, which refers to the same accessors.
/// asset_members.h maps names to members, whose units apply; null stands for an infinite limit.
std::string WriteAsset(const Head& head, std::span<const ExportedShape> shapes);

}  // namespace fsm
