#pragma once

#include <string>

#include "face_fit/fit/fit.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Another photo of the person of a fit, from the side.
struct SideFit {
  FoundFace face;
  CameraPose pose;
  float residual_mm = 0;  ///< of its points from the fitted head as seen from there
};

/// Finds the pose of the fitted head in a photo from the side. The head is drawn in that pose and
/// shown to the same network: what the network gets wrong of the drawn head is subtracted from what
/// it says of the photo. Errors (kBadValue, in words): no face; from the front again; turned too
/// far; not this face.
vm::Result<SideFit> FitSideView(FaceNetworks& networks, const BaseHead& base, const Fit& fit,
                                const fsm::Image& photo);

/// Corrects the depth of the fit's constraints until skin seen in both photos lies at one place in
/// space, warps the head again, and refines the pose of `view`. Leaves both as they are if too
/// little skin is found in both.
void RefineDepthBySide(const BaseHead& base, const fsm::Image& front, const fsm::Image& side,
                       SideFit& view, Fit& fit);

}  // namespace facefit
