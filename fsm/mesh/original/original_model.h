#pragma once

#include "fsm/mesh/mesh_model.h"
#include "fsm/mesh/original/original_face.h"

namespace fsm {

/// The face as a mesh of our frame; vertex i of the wireframe is vertex i of the model. Its
/// view is the window the original shows a face through, without
/// perspective: its middle is the origin of the wireframe, and half its longer side is one of the
/// wireframe's units.
MeshModel ModelOfOriginal(const OriginalFace& face);

}  // namespace fsm
