#pragma once

#include <span>
#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// The constraints with those of closed inner lips replaced by the line where the photo shows them
/// to meet; those of the outer lips beside a corner are moved along. `now`: the base head's
/// vertices with the photo's expression, millimetres.
std::vector<LandmarkConstraint> ConstrainToMouthLine(const ObservedHead& base,
                                                     const FoundFace& face, const CameraPose& pose,
                                                     std::span<const glm::vec3> now,
                                                     const fsm::Image& photo,
                                                     std::vector<LandmarkConstraint> constraints);

/// Positions of the vertices of the fitted head's skin as fsm will show it in a state, millimetres.
/// They are the first vertices of that head and have the numbers of those of the base head.
std::vector<glm::vec3> SkinWith(const FittedHead& fitted, const fsm::FaceState& state);

/// The base head, which outlives the result, warped until it shows its points where the photo does.
FittedHead WarpToLandmarks(const ObservedHead& base, const CameraPose& pose,
                           const Expression& expression, const PhotoTargets& targets);

}  // namespace facefit
