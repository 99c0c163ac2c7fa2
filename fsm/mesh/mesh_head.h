#pragma once

#include <memory>

#include "fsm/mesh/mesh_model.h"

namespace fsm {

/// A rig whose skin only turns with the head. It has the units of the built-in heads.
RigData MakeStillSkin();
/// Makes a head of `model`. `skin` holds the steps that shape its skin (ShapesSkin) and what these
/// need, by the model's vertices; the steps of eyes, jaw, neck, springs and normals are added, and
/// how open each vertex is to light. Throws std::runtime_error if the model has no triangles.
std::unique_ptr<Head> MakeMeshHead(MeshModel model, RigData skin = MakeStillSkin());

}  // namespace fsm
