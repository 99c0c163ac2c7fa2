#pragma once

#include <string>

#include "face_fit/fit/fit.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Another photo of the person of a fit, from the side.
struct View {
  FoundFace face;
  Pose pose;
  float residual_mm = 0;  ///< of its points from the fitted head as seen from there
};

/// Looks at a photo that should show the fitted person from the side. The fitted head is drawn from
/// there and shown to the same network, so that what that gets wrong of turned faces is known and
/// taken off. Errors (kBadValue, in words): no face; from the front again; not this face.
vm::Result<View> PlaceView(FaceNetworks& networks, const BaseHead& base, const Fit& fit,
                           const fsm::Image& photo);

/// Moves the fit's places towards or from the first photo's camera until the skin around them is
/// seen where it lies in the view, and forms the head anew. Makes the view's pose better.
void Deepen(const BaseHead& base, const fsm::Image& front, const fsm::Image& side, View& view,
            Fit& fit);

}  // namespace facefit
