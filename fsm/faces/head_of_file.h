#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsm/asset/asset_writer.h"
#include "fsm/base/table_folder.h"
#include "fsm/motion/motion_tables.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A head of a file, and what there is to say about it.
struct FileHead {
  std::unique_ptr<Head> head;
  std::string notice;                    ///< what it lacks; or nothing
  std::vector<std::string> named_files;  ///< ImportedHead::named_files
  bool by_shapes = false;                ///< moved by its own shapes: other units need it made anew
};

/// A head out of .obj, .glb, .gltf or .vrm. One that ExportHead has written is what it was. Any
/// other is moved by its own shapes where their names are ARKit's or VRM's, else by ours carried
/// over with the points of `path`.points; without either only head, eyes and jaw move, and the
/// notice says so. `units`: in place of those of `tables`. Throws std::runtime_error.
FileHead MakeHeadOfFile(const std::string& path, const TableFolder& tables,
                        const std::optional<UnitTable>& units = {});

/// Every ARKit shape of the tables as a state of the face.
std::vector<ExportedShape> ArkitShapes(const MotionTables& tables);

/// Writes a head with all ARKit shapes; see WriteAsset. Errors: kUnavailable.
vm::Result<void> ExportHead(const Head& head, const MotionTables& tables, const std::string& path);

}  // namespace fsm
