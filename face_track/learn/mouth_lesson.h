#pragma once

#include <string>

#include "face_track/model/lips.h"

namespace facetrack {

/// Draws `heads` heads that hold known mouths, follows them as films are followed, and returns how
/// the mouth parameters are told from the lips seen. Says on standard error how near it comes.
/// Throws std::runtime_error: networks fail, or a face is not seen.
MouthOfLips LearnMouth(std::size_t heads, const std::string& networks);

}  // namespace facetrack
