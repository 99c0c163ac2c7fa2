#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// How both eyes must be moved, turned and sized, and their lids raised, so that the outlines of
/// the open eyes lie as in the photo. `to`: by point of the network, millimetres in the head's
/// frame. REQUIRES: it has the points of both EyeOutlines.
fsm::Sided<fsm::EyeTransform> FitEyes(const ObservedHead& base,
                                      const std::map<PointIndex, glm::vec3>& to);

/// The eyes at rest. A part of a smile's squint is kept (squint_kept of the table): the photo does
/// not show how wide the eyes would be without it, and eyes that are too wide stare.
fsm::Sided<fsm::EyeTransform> EyesAtRest(const FittedHead& fitted);

}  // namespace facefit
