#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

/// Adds the lashes of both sides, which move as skin. `of_photo`: only those of the upper lids,
/// with their darkness in MeshBuilder::opacity.
void BuildLashes(const EyeAnatomy& eye, const Identity& identity, bool of_photo, MeshBuilder& mesh);

}  // namespace fsm
