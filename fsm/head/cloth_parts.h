#pragma once

#include "fsm/head/features.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/paint.h"

namespace fsm {

/// The shoulders, which move as skin: to be added before the rigid parts, so that such vertices
/// stay one run.
void BuildCloth(const Features& features, const Palette& palette, HeadMesh& mesh);

}  // namespace fsm
