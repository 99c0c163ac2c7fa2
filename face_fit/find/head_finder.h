#pragma once

#include "face_fit/find/face_networks.h"
#include "fsm/mesh/head_file.h"

namespace facefit {

/// Finds eyes, nose and mouth of somebody else's head as on a photo: both heads are drawn, the
/// landmark network looks at both, and its points are followed back onto the meshes. `face`: the
/// built-in head of the pairs. Throws std::runtime_error if no face is seen from any side.
fsm::HeadPoints FindHeadPoints(FaceNetworks& networks, const fsm::HeadFile& file,
                               const std::string& name, const std::string& face);

}  // namespace facefit
