#pragma once

#include <memory>

#include "fsm/mesh/mesh_model.h"

namespace fsm {

/// Skin that nothing but the head's turn moves; with the units of built-in heads.
RigData StillSkin();
/// A head that shows `model`, whose skin moves as `skin` says: steps and what they need, by the
/// model's vertices. Eyes, jaw, neck and light are added. Throws std::runtime_error if the model
/// has no triangles.
std::unique_ptr<Head> MakeMeshHead(MeshModel model, RigData skin = StillSkin());

}  // namespace fsm
