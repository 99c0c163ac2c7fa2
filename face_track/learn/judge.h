#pragma once

#include "face_track/learn/sitter.h"
#include "face_track/model/seen_face.h"

namespace facetrack {

/// Prints how turns and units of a head are found that is met in one picture as a stranger: how far
/// off the angles are, each counted from the rest, and the doses.
void Judge(const SeenFace& face, Sitter& sitter);

}  // namespace facetrack
