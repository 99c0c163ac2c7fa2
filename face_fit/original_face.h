#pragma once

#include <string>

#include "face_fit/find/face/hand_points.h"
#include "fsm/image/image.h"

namespace facefit {

/// A face from a configuration of the original, and the points of its fitted wireframe.
struct OriginalFace {
  fsm::Image photo;
  HandPoints points;
};

/// Reads the face `name` of the configuration file `config_path`. Throws std::runtime_error if
/// there is none, or if a file cannot be read.
OriginalFace ReadOriginalFace(const std::string& config_path, const std::string& name);

}  // namespace facefit
