#pragma once

#include <string>
#include <string_view>

#include "fsm/mesh/imported_head.h"

namespace fsm {

/// A .gltf, .glb or .vrm file. Errors: as ReadImportedHead.
vm::Result<ImportedHead> ReadGltfHead(const std::string& path);
/// From memory; nothing outside it is read. `name` is for messages.
vm::Result<ImportedHead> ParseGltfHead(const std::string& name, std::string_view bytes);

}  // namespace fsm
