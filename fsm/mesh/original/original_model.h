#pragma once

#include "fsm/mesh/mesh_model.h"
#include "fsm/mesh/original/original_face.h"

namespace fsm {

/// Converts a face to a mesh in our frame; vertex i of the wireframe becomes vertex i of the model.
/// The model's view is the orthographic one of the original's window: its centre is the origin of
/// the wireframe, and half its longer side is one unit of the wireframe.
MeshModel ModelOfOriginal(const OriginalFace& face);

}  // namespace fsm
