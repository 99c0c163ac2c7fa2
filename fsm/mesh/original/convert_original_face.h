#pragma once

#include "fsm/mesh/original/original_face.h"
#include "fsm/mesh/unrigged_head.h"

namespace fsm {

/// Converts a face to a mesh in our frame; vertex i of the wireframe becomes vertex i of the model.
/// The model's view is the orthographic one of the original's window: its centre is the origin of
/// the wireframe, and half its longer side is one unit of the wireframe.
UnriggedHead ConvertOriginalFace(const OriginalFace& face);

}  // namespace fsm
