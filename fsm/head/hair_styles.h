#pragma once

#include <vector>

#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

/// Adds short hair all around. REQUIRES: identity.crop.
void BuildCroppedHair(const Identity& identity, MeshBuilder& mesh);
/// Adds parted hair that hangs down.
void BuildLongHair(const Identity& identity, MeshBuilder& mesh);

/// Both return single hairs on the skin beside the edge of the hair, so that it does not begin at a
/// line. `skin`: before it takes the identity's form.
std::vector<SkinStroke> CroppedHairline(const Identity& identity, const MeshBuilder& skin);
std::vector<SkinStroke> LongHairline(const Identity& identity, const MeshBuilder& skin);

}  // namespace fsm
