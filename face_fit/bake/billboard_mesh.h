#pragma once

#include "face_fit/bake/texture_bake.h"

namespace facefit {

/// The figure's colours with the face taken out and the gap filled from around it: this shows
/// beside the face when the head turns.
fsm::Image BehindFace(const BaseHead& base, const Fit& fit, const Figure& figure);

/// Makes the mesh that carries hair, neck and clothes: a sheet just behind the face, from there
/// gently back to the outline, its triangles sorted from back to front. Fills head.sheet,
/// head.sheet_triangles, head.seen_from and head.skin_bottom_y.
void MakeBillboard(const BaseHead& base, const Fit& fit, const Figure& figure,
                   fsm::PhotoHead& head);

}  // namespace facefit
