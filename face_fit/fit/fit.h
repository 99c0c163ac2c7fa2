#pragma once

#include <functional>
#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/found_face.h"
#include "face_fit/fit/constraints.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// The base head fitted to a face, and what it was fitted to.
struct FaceFit {
  FittedHead head;
  std::vector<PixelConstraint> constraints;  ///< what the head was warped to
  PhotoIrises irises;
};

/// Fits the base head to the points of a face: pose and expression by least squares, then the form
/// by a warp. `photo` corrects the points, which miss the irises and the lip seam by some pixels.
/// Pure; thread: any. REQUIRES: `base` outlives the result.
FaceFit FitFace(const ObservedHead& base, const FoundFace& face, const fsm::Image& photo);

/// Returns the mean distance of the face's points from those of the fitted head, millimetres.
float ResidualMm(const FoundFace& face, const FittedHead& fitted);

/// Returns the fit with its head warped to constraints moved towards the camera, each by what
/// `nearer_mm` returns for it.
FaceFit WithDepthShifted(FaceFit fit,
                         const std::function<float(const PixelConstraint&)>& nearer_mm);

}  // namespace facefit
