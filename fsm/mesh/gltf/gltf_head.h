#pragma once

#include <string>
#include <string_view>

#include "fsm/mesh/imported_head.h"

namespace fsm {

/// Reads a .gltf, .glb or .vrm file. Errors: as ReadImportedHead.
vm::Result<ImportedHead> ReadGltfHead(const std::string& path);
/// Reads such a file from memory; files that it names are not opened. `name`: the file name in
/// messages.
vm::Result<ImportedHead> ParseGltfHead(const std::string& name, std::string_view bytes);

}  // namespace fsm
