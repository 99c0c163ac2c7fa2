#pragma once

#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/fit/photo_targets.h"

namespace facefit {

/// Positions of the vertices of the fitted head's skin as fsm will show it in a state, millimetres.
/// They are the first vertices of that head and have the numbers of those of the base head.
std::vector<glm::vec3> SkinWith(const FittedHead& fitted, const fsm::FaceState& state);

/// The base head, which outlives the result, warped until it shows its points where the photo does.
FittedHead WarpToLandmarks(const ObservedHead& base, const CameraPose& pose,
                           const Expression& expression, const PhotoTargets& targets);

}  // namespace facefit
