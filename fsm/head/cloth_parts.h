#pragma once

#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

/// Adds the shoulders, which move as skin.
void BuildCloth(const Identity& identity, MeshBuilder& mesh);

}  // namespace fsm
