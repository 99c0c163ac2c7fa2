#pragma once

#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/fit/photo_targets.h"

namespace facefit {

struct Fit {
  FittedHead head;
  PhotoTargets targets;
  PhotoIrises irises;
  float residual_mm = 0;  ///< mean distance of the network's points from those of the head
};

/// Fits the base head to the points of a face: pose and expression by least squares, then the form
/// by a warp. `photo`, if given, shows the irises and the line where closed lips meet, which the
/// points miss by some pixels. Pure; thread: any. REQUIRES: face.points has kNetworkPoints; `base`
/// outlives the result.
Fit FitFace(const ObservedHead& base, const FoundFace& face, const fsm::Image* photo = nullptr);

/// The fit with other constraints: its head is warped again, its residual stays that of the first
/// warp.
Fit WithConstraints(const Fit& fit, std::vector<LandmarkConstraint> constraints);

}  // namespace facefit
