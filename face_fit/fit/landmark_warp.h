#pragma once

#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/constraints.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// Returns the positions of the fitted head's skin as fsm will show it in a state, head's frame,
/// millimetres: the first vertices of that head, numbered as in the base head.
std::vector<glm::vec3> SkinWith(const FittedHead& fitted, const fsm::FaceState& state);

/// Warps the base head, which outlives the result, until its points lie where the photo shows them.
FittedHead WarpToLandmarks(const ObservedHead& base, const CameraPose& pose,
                           const Expression& expression,
                           std::span<const LandmarkConstraint> constraints);

}  // namespace facefit
