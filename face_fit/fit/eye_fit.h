#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>

#include "face_fit/find/head/base_head.h"
#include "fsm/rig/eye_transform.h"

namespace facefit {

/// How both eyes must be moved, turned and sized, and their lids raised, so that the outlines of
/// the open eyes lie as in the photo. `to`: by point of the network, millimetres in the head's
/// frame. REQUIRES: it has the points of both EyeOutlines.
fsm::Sided<fsm::EyeTransform> FitEyes(const BaseHead& base,
                                      const std::map<PointIndex, glm::vec3>& to);

}  // namespace facefit
