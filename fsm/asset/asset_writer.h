#pragma once

#include <span>
#include <string>

#include "fsm/rig/head.h"

namespace fsm {

/// A shape for other programs: what it is called, and the state that shows it at full strength.
struct ExportedShape {
  std::string name;
  FaceState state;
};

/// A head as one file, binary glTF 2.0. Other programs see a mesh at rest that looks towards +z
/// (the node scales our millimetres to metres), with one primitive for each part, colours of the
/// vertices or the photo as texture, and each of `shapes` as a morph target named in
/// extras.targetNames. ParseAsset reads exactly the written head from the extension, which refers
/// to the same accessors. asset_members.h says which member a name stands for, in whose unit its
/// numbers are; null stands for an infinite limit.
std::string WriteAsset(const Head& head, std::span<const ExportedShape> shapes);

}  // namespace fsm
