#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsm/asset/asset_writer.h"
#include "fsm/motion/motion_tables.h"
#include "fsm/rig/head.h"

namespace fsm {

/// What MakeHeadOfFile found out about a head.
struct HeadReport {
  std::string notice;               ///< what it lacks; or nothing
  std::vector<std::string> beside;  ///< HeadFile::beside
  bool by_shapes = false;           ///< moved by its own shapes: other units need it made anew
};

/// A head out of .obj, .glb, .gltf or .vrm. One that ExportHead has written is what it was. Any
/// other is moved by its own shapes where their names are ARKit's or VRM's, else by ours carried
/// over with the points of `path`.points; without either only head, eyes and jaw move, and a notice
/// says so: in `report`, else on stderr. `units`: in place of those of `tables`. Throws
/// std::runtime_error.
std::unique_ptr<Head> MakeHeadOfFile(const std::string& path, const std::string& tables,
                                     HeadReport* report = nullptr,
                                     const std::optional<UnitTable>& units = {});

/// Every ARKit shape of the tables as a state of the face.
std::vector<ExportedShape> ArkitShapes(const MotionTables& tables);

/// Writes a head with all ARKit shapes; see WriteAsset. Errors: kUnavailable.
vm::Result<void> ExportHead(const Head& head, const MotionTables& tables, const std::string& path);

}  // namespace fsm
