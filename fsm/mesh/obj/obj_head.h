#pragma once

#include <string>

#include "fsm/mesh/imported_head.h"

namespace fsm {

/// Reads an .obj file with its materials and pictures. Errors: as ReadImportedHead.
vm::Result<ImportedHead> ReadObjHead(const std::string& path);

}  // namespace fsm
