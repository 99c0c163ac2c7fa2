#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fsm/base/table_folder.h"
#include "fsm/mesh/original/original_files.h"
#include "fsm/motion/motion_tables.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A face that is made when it is worn. `make` throws std::runtime_error with a sentence; it may be
/// called on another thread.
struct NamedFace {
  std::string name;
  std::function<std::unique_ptr<Head>()> make;
};

/// The faces of a configuration of the original.
struct OriginalFaceList {
  std::vector<NamedFace> faces;
  std::vector<std::string> left_out;  ///< a sentence for each face whose files are not there
};
OriginalFaceList OriginalFaces(std::span<const OriginalFaceFiles> faces,
                               const OriginalSharedFiles& shared, const TableFolder& tables);

/// Looks of whole expressions by FaceExp's name and pattern: those of the files beside the standard
/// wireframe (AU31.pnt ..., user*.pnt, userdef*.pnt), so that FaceExp shows them on every face.
/// Those that cannot be read are left out, and a sentence on stderr says so.
ExpressionLooks LooksOfExpressions(const OriginalSharedFiles& shared);

}  // namespace fsm
