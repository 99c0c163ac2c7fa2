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
/// extras.targetNames. We read back from the extension exactly the head that was written; it refers
/// to the same accessors, and numbers of every array are in the unit of the member that
/// asset_members.h gives that name; null stands for a limit that there is not.
std::string WriteAsset(const Head& head, std::span<const ExportedShape> shapes);

}  // namespace fsm
