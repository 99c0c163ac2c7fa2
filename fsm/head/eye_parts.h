#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

void BuildEyes(const EyeAnatomy& eye, const Identity& identity, MeshBuilder& mesh);

}  // namespace fsm
