#pragma once

#include <memory>

#include "fsm/mesh/unrigged_head.h"

namespace fsm {

/// Returns a rig whose skin moves only with the head. It has the units of the built-in heads.
RigData MakeStillSkin();
/// Makes a head from `model`. `skin` has the steps that shape its skin (ShapesSkin) and their data,
/// indexed by the model's vertices. Adds the steps of eyes, jaw, neck, springs and normals, and the
/// ambient occlusion of each vertex. Throws std::runtime_error if the model has no triangles.
std::unique_ptr<Head> RigUnriggedHead(UnriggedHead model, RigData skin = MakeStillSkin());

}  // namespace fsm
