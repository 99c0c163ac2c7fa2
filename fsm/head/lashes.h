#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

/// Lashes of both sides. They move as skin and must be added before the rigid parts, so that such
/// vertices stay one run. `of_photo`: those of the upper lids alone, with how dark they are in
/// HeadMesh::opacity.
void BuildLashes(const EyeAnatomy& eye, const Identity& identity, bool of_photo, HeadMesh& mesh);

}  // namespace fsm
