#pragma once

#include "fsm/mesh/imported_head.h"

namespace facefit {

class FaceNetworks;

/// Finds eyes, nose and mouth of another maker's head as on a photo: both heads are drawn, the
/// landmark network looks at both, and its points are projected back onto the meshes. The head may
/// face z, -z, x or -x with y up, or -y with z up; the direction with the closest match to the base
/// head wins. `base_name`: the built-in head of the pairs. Error: kBadValue, no face is seen from
/// any side, or none from the front. Throws std::runtime_error if the file is not one of a head, or
/// if rendering is impossible.
vm::Result<fsm::HeadPoints> FindHeadPoints(FaceNetworks& networks, const fsm::ImportedHead& file,
                                           const std::string& name, const std::string& base_name);

}  // namespace facefit
