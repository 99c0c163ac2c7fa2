#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>

#include "face_fit/fit/base_head.h"
#include "fsm/rig/eye_transform.h"

namespace facefit {

/// How eyes and lids must sit for the outlines of the open eyes to lie where they should. `to`: by
/// point of the network, millimetres in the head's frame, at least those of EyeOutline.
std::array<fsm::EyeTransform, 2> FitEyes(const BaseHead& base, const std::map<int, glm::vec3>& to);

}  // namespace facefit
