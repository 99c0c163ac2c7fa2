#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fsm/base/log.h"
#include "fsm/base/table_folder.h"
#include "fsm/mesh/original/original_files.h"
#include "fsm/motion/inputs/expression_table.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A face that is made when it is first used. `make` throws std::runtime_error; it may be called on
/// another thread.
struct NamedFace {
  std::string name;
  std::function<std::unique_ptr<Head>()> make;
};

/// The faces of a configuration of the original.
struct OriginalFaceList {
  std::vector<NamedFace> faces;
  std::vector<std::string> left_out;  ///< a sentence for each face whose files do not exist
};
OriginalFaceList OriginalFaces(std::span<const OriginalFaceFiles> faces,
                               const OriginalSharedFiles& shared, const TableFolder& tables);

/// Returns the looks of whole expressions from the files beside the standard wireframe (AU31.pnt
/// ..., user*.pnt, userdef*.pnt), so that FaceExp can show them on every face. Files that cannot be
/// read are skipped and reported to `log`.
ExpressionLooks LooksOfExpressions(const OriginalSharedFiles& shared, const Log& log);

}  // namespace fsm
