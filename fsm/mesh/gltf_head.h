#pragma once

#include <string>
#include <string_view>

#include "fsm/mesh/head_file.h"

namespace fsm {

/// A .gltf, .glb or .vrm file. Errors: as ReadHeadFile.
vm::Result<HeadFile> ReadGltfHead(const std::string& path);
/// From memory; nothing outside it is read. `name` is for messages.
vm::Result<HeadFile> ParseGltfHead(const std::string& name, std::string_view bytes);

}  // namespace fsm
