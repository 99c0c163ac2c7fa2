#pragma once

#include <glm/vec3.hpp>
#include <map>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Returns how both eyes must be moved, turned and sized, and their lids raised, so that the
/// outlines of the open eyes lie as in the photo. `to`: positions by point of the network, head's
/// frame, millimetres. REQUIRES: it has the points of both of point::kEyeOutline.
fsm::Sided<fsm::EyeTransform> FitEyes(const ObservedHead& base,
                                      const std::map<PointIndex, glm::vec3>& to);

/// Returns the eyes at rest, which keep a share of a smile's squint (row squint_kept_share of
/// tables/photo_look.txt): the photo does not show how wide they would be without it, and eyes that
/// are too wide stare.
fsm::Sided<fsm::EyeTransform> EyesAtRest(const FittedHead& fitted);

}  // namespace facefit
