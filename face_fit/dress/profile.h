#pragma once

#include "face_fit/dress/field.h"
#include "face_fit/fit/fit.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// A photo in full profile, by the line of brow, nose, lips and chin against what is behind.
struct ProfileView {
  Pose pose;
  float residual_mm = 0;  ///< mean distance of that line from the fitted head's, before it was used
};

/// Finds the fitted head's profile on the outline of a figure (`opacity`: 1 = figure), moves the
/// fit's places near the middle of the face towards or from the first photo's camera until both
/// lines agree, and forms the head anew. Errors (kBadValue, in words): no outline like it; then the
/// fit is as it was.
vm::Result<ProfileView> DeepenByProfile(const BaseHead& base, const FloatImage& opacity, Fit& fit);

}  // namespace facefit
