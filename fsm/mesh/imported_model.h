#pragma once

#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/mesh_model.h"

namespace fsm {

/// The height of the mouth of built-in heads, millimetres.
inline constexpr float kUsualMouthY = -43;
/// The head in our frame: `to_ours` takes it there. Parts are told by their names, and rigid ones
/// by where they lie to the mouth, which is at `mouth_y`. Throws std::runtime_error naming file and
/// vertex if `to_ours` takes one out of kMaxMeshReach, as where landmarks do not belong to the
/// head.
MeshModel ModelOfImport(const ImportedHead& file, const Similarity& to_ours, float mouth_y);

}  // namespace fsm
