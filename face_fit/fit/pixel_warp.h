#pragma once

#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/constraints.h"
#include "face_fit/fit/fitted_head.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// Returns the form of a fitted head as fsm makes it, with the eyes of the photo's expression; what
/// the photo paints on it is left out.
fsm::PhotoHead PhotoHeadOf(const FittedHead& fitted);

/// Returns the positions of the fitted head's skin as fsm will show it in a state, head's frame,
/// millimetres: the first vertices of that head, numbered as in the base head.
std::vector<glm::vec3> SkinWith(const FittedHead& fitted, const fsm::FaceState& state);

/// Warps the base head, which outlives the result, so that its points lie where the photo shows
/// them. Four fifths of what is still off then are corrected, once; outlines of the eyes, which
/// move with them as wholes, are not corrected. `base_in_expression`: as FittedHead's.
FittedHead WarpToPixels(const ObservedHead& base, const CameraPose& pose,
                        const Expression& expression, std::vector<glm::vec3> base_in_expression,
                        std::span<const PixelConstraint> constraints);

}  // namespace facefit
