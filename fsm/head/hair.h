#pragma once

#include <vector>

#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"

namespace fsm {

/// Adds short hair all around. REQUIRES: identity.crop.
void BuildCroppedHair(const Identity& identity, HeadMesh& mesh);
/// Adds parted hair that hangs down.
void BuildLongHair(const Identity& identity, HeadMesh& mesh);
inline void BuildHair(const Identity& identity, HeadMesh& mesh) {
  identity.crop ? BuildCroppedHair(identity, mesh) : BuildLongHair(identity, mesh);
}

/// Returns single hairs on the skin beside the edge of the hair, so that it does not begin at a
/// line. `mesh`: the skin before it takes the identity's form.
std::vector<SkinHair> CroppedHairline(const Identity& identity, HeadMesh& mesh);
std::vector<SkinHair> LongHairline(const Identity& identity, HeadMesh& mesh);
inline std::vector<SkinHair> Hairline(const Identity& identity, HeadMesh& mesh) {
  return identity.crop ? CroppedHairline(identity, mesh) : LongHairline(identity, mesh);
}

}  // namespace fsm
