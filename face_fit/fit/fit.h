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
  float residual_mm = 0;  ///< mean distance of the face's points from those of the head
};

/// Fits the base head to the points of a face: pose and expression by least squares, then the form
/// by a warp. `photo`, if given, corrects the points, which miss the irises and the line between
/// closed lips by some pixels. Pure; thread: any. REQUIRES: face.points has kNetworkPoints; `base`
/// outlives the result.
Fit FitFace(const ObservedHead& base, const FoundFace& face, const fsm::Image* photo = nullptr);

/// Returns the fit with its head warped to other constraints; residual_mm is not computed again.
Fit WithConstraints(const Fit& fit, std::vector<LandmarkConstraint> constraints);

}  // namespace facefit
