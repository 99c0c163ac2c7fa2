#pragma once

#include <string>

#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/fit.h"

namespace facefit {

/// What was measured, a line each, and warnings of what will look worse than it could.
std::string Report(const FoundFace& face, const Fit& fit, const fsm::Image& photo, float coverage,
                   int faces, bool glasses, const Occlusion& occlusion = {});

}  // namespace facefit
