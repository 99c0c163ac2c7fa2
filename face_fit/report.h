#pragma once

#include <string>

#include "face_fit/bake/texture_bake.h"
#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/fit.h"

namespace facefit {

/// What was measured, a line each, and warnings of what will look worse than it could. `bake`: what
/// was made of them; its picture is not looked at.
std::string Report(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                   const TextureBake& bake, int faces, const Occlusion& occlusion = {});

}  // namespace facefit
