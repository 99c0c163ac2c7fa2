#pragma once

#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

/// Adds the shoulders, which move as skin.
void BuildCloth(const Identity& identity, HeadMesh& mesh);

}  // namespace fsm
