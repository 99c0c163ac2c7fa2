#pragma once

#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

/// The shoulders, which move as skin: to be added before the rigid parts, so that such vertices
/// stay one run.
void BuildCloth(const Identity& identity, HeadMesh& mesh);

}  // namespace fsm
