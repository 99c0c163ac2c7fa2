#pragma once

#include <cstddef>

#include "fsm/mesh/mesh_model.h"
#include "fsm/rig/lip_rig.h"

namespace fsm {

/// Keeps the lips of a mesh from crossing, and closes them on demand. Knows them by model.seam, and
/// without it does nothing. Of the vertices the first `count` are considered.
LipRig LipsOf(const MeshModel& model, std::size_t count);

}  // namespace fsm
