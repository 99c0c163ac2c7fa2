#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/rig/head.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// A shape for other programs: what it is called, and the state that shows it at full strength.
struct ExportedShape {
  std::string name;
  FaceState state;
};

/// The extension of glTF that holds what only we need of a head.
inline constexpr const char* kAssetExtension = "GALATEA_head";

/// A head as one file, binary glTF 2.0. Other programs see a mesh at rest that looks towards +z
/// (the node scales our millimetres to metres), with one primitive for each part, colours of the
/// vertices or the photo as texture, and each of `shapes` as a morph target named in
/// extras.targetNames. We read back from the extension exactly the head that was written; it refers
/// to the same accessors, and numbers of every array are in the unit of the member of that name
/// (head_asset.h, rig_data.h); null stands for a limit that there is not.
std::string WriteAsset(const Head& head, std::span<const ExportedShape> shapes);

/// True if the file is glTF with our extension; nothing else about it is looked at.
bool IsAsset(std::string_view bytes);

/// The head of a file that WriteAsset has made. `name` is for messages. Nothing outside the bytes
/// is read. Errors: kBadValue and kLimit, naming file and member.
vm::Result<HeadAsset> ParseAsset(const std::string& name, std::string_view bytes);

}  // namespace fsm
