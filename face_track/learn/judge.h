#pragma once

#include "face_track/learn/sitter.h"
#include "face_track/model/seen_face.h"

namespace facetrack {

/// Prints how far off the angles of a turned head are found whose truth is known: with its own
/// points known, and met in one picture as a stranger.
void Judge(const SeenFace& face, Sitter& sitter);

}  // namespace facetrack
