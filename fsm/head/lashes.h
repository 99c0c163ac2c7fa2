#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

/// Adds the lashes of both sides, which move as skin. `of_photo`: only those of the upper lids,
/// with their darkness in HeadMesh::opacity.
void BuildLashes(const EyeAnatomy& eye, const Identity& identity, bool of_photo, HeadMesh& mesh);

}  // namespace fsm
