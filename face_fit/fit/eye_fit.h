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

/// Without a photo irises lie where the eyes' outlines say, with a contrast of 0.
PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image* photo);
/// The constraints with the outlines of eyes moved up or down where the irises show that the
/// network misplaced them.
std::vector<LandmarkConstraint> ShiftLidsToIrises(const ObservedHead& base,
                                                  const PhotoIrises& irises,
                                                  std::vector<LandmarkConstraint> constraints);

/// The eyes at rest. A part of a smile's squint is kept (squint_kept of the table): the photo does
/// not show how wide the eyes would be without it, and eyes that are too wide stare.
fsm::Sided<fsm::EyeTransform> EyesAtRest(const FittedHead& fitted);

}  // namespace facefit
