#pragma once

#include <cstddef>
#include <vector>

#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"

namespace fsm {

/// Adds short hair all around, `up_to` a fraction of the way from the hairline to the crown.
/// REQUIRES, here and below: that is its hair.
void BuildCroppedHair(const Identity& identity, MeshBuilder& mesh, float up_to = 1);
/// Adds parted hair that hangs down.
void BuildLongHair(const Identity& identity, MeshBuilder& mesh);
/// Adds hair that is combed back. Returns the first vertex of what hangs; all others lie
/// on the head.
std::size_t BuildCombedHair(const Identity& identity, MeshBuilder& mesh);

/// All return single hairs on the skin beside the edge of the hair, so that it does not begin at a
/// line. `skin`: before it takes the identity's form.
std::vector<SkinStroke> CroppedHairline(const Identity& identity, const MeshBuilder& skin);
std::vector<SkinStroke> LongHairline(const Identity& identity, const MeshBuilder& skin);
std::vector<SkinStroke> CombedHairline(const Identity& identity, const MeshBuilder& skin);

}  // namespace fsm
