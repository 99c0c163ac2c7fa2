#pragma once

#include <vector>

#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

/// Adds parted hair that hangs down.
void BuildLongHair(const Identity& identity, MeshBuilder& mesh);
/// Returns single hairs on the skin beside the edge of the hair, so that it does not begin at a
/// line. `skin`: before it takes the identity's form.
std::vector<SkinStroke> LongHairline(const Identity& identity, const MeshBuilder& skin);

}  // namespace fsm
