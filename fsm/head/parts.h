#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/face_surface.h"
#include "fsm/head/rig.h"

namespace fsm {

/// The parts beside the skin. Each adds its vertices for both sides. Brows and lashes are flesh and
/// must be added before the rigid parts, so that flesh stays one run of vertices.
void BuildBrows(const FaceSurface& surface, const MouthAnatomy& mouth, HeadMesh& mesh);
void BuildLashes(const EyeAnatomy& eye, HeadMesh& mesh);

void BuildEyes(const EyeAnatomy& eye, HeadMesh& mesh);
void BuildTeeth(const MouthAnatomy& mouth, HeadMesh& mesh);
void BuildTongue(const MouthAnatomy& mouth, HeadMesh& mesh);
void BuildEars(HeadMesh& mesh);
void BuildHair(HeadMesh& mesh);

}  // namespace fsm
