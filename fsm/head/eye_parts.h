#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

void BuildEyes(const EyeAnatomy& eye, const Identity& identity, HeadMesh& mesh);

}  // namespace fsm
