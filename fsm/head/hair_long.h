#pragma once

#include <vector>

#include "fsm/head/features.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/paint.h"

namespace fsm {

struct LongStyle {
  float parting = 0.17f;  ///< to the agent's left, as part of the hair's half width
  float full_mm = 0;      ///< more volume over the skull than usual
  float front_y = -84;    ///< height of the ends beside the face, millimetres
  float back_y = -112;    ///< of those behind
  float wave_mm = 2.2f;   ///< sideways swing of what hangs
};
/// Single hairs on the skin beside the edge of the hair, so that it does not begin on a line.
/// `mesh`: the skin before it takes the identity's form.
std::vector<SkinHair> LongHairline(const LongStyle& style, const Features& features,
                                   const Palette& palette, HeadMesh& mesh);
/// Parted and hanging.
void BuildLongHair(const LongStyle& style, const Features& features, const Palette& palette,
                   HeadMesh& mesh);

}  // namespace fsm
