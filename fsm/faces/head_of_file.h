#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsm/asset/asset_writer.h"
#include "fsm/base/table_folder.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A head made from a file, with notices.
struct FileHead {
  std::unique_ptr<Head> head;
  std::string notice;                    ///< sentences about what the file lacks; or empty
  std::vector<std::string> named_files;  ///< ImportedHead::named_files
  bool by_shapes = false;  ///< moved by the file's shapes; for other units it must be made anew
};

/// Makes a head from an .obj, .glb, .gltf or .vrm file. A file of ExportHead gives the exported
/// head. Any other head is moved by its own shapes if these have ARKit's or VRM's names, else by a
/// rig transferred from a built-in head with the points of `path`.points; without either, only
/// head, eyes and jaw move, and the notice says so. `units` replaces those of `tables`. Throws
/// std::runtime_error.
FileHead MakeHeadOfFile(const std::string& path, const TableFolder& tables,
                        const std::optional<UnitTable>& units = {});

/// Returns every ARKit shape of the tables as a state of the face.
std::vector<ExportedShape> ArkitShapes(const MotionTables& tables);

/// Writes a head with all ARKit shapes; see WriteAsset. Errors: kUnavailable.
vm::Result<void> ExportHead(const Head& head, const MotionTables& tables, const std::string& path);

}  // namespace fsm
