#pragma once

#include "face_fit/find/network/found_face.h"

namespace facefit {

/// Returns whether a face wears glasses: whether a bar that contrasts with the skin above and below
/// it crosses the bridge of the nose, where glasses rest.
bool WearsGlasses(const FoundFace& face, const fsm::Image& photo);

}  // namespace facefit
