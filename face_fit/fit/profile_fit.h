#pragma once

#include "face_fit/fit/fit.h"
#include "face_fit/picture/float_image.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Pose of the head in a photo in full profile.
struct ProfileFit {
  CameraPose pose;
  float residual_mm = 0;  ///< mean distance of that line from the fitted head's, before it was used
};

/// Finds the line of brow, nose, lips and chin of the fitted head on the outline of a figure
/// (`opacity`: 1 = figure), corrects the depth of the fit's constraints near the middle of the face
/// until both lines agree, and warps the head again. Errors (kBadValue, in words): no outline like
/// it; then the fit is as it was.
vm::Result<ProfileFit> RefineDepthByProfile(const BaseHead& base, const FloatImage& opacity,
                                            Fit& fit);

}  // namespace facefit
