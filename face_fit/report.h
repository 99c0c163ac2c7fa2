#pragma once

#include <string>

#include "face_fit/bake/texture_bake.h"
#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/fit.h"

namespace facefit {

/// Returns the measurements, a line each, and warnings of what could look better. `bake`: what
/// BakeTexture made of the face, the fit and the photo; `faces`: number of faces found.
std::string Report(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                   const TextureBake& bake, int faces, const Occlusion& occlusion = {});

}  // namespace facefit
