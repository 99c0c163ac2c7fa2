#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/features.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/paint.h"

namespace fsm {

/// Adds both eyeballs.
void BuildEyes(const EyeAnatomy& eye, const Features& features, const Palette& palette,
               HeadMesh& mesh);

}  // namespace fsm
