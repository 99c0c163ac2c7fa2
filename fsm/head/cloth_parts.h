#pragma once

#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

/// Adds the shoulders. They move as skin and must be added before the rigid parts, so that the
/// vertices that move as skin are contiguous.
void BuildCloth(const Identity& identity, HeadMesh& mesh);

}  // namespace fsm
