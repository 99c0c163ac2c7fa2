#pragma once

#include <vector>

#include "face_fit/fit/fit.h"
#include "face_fit/fit/view.h"

namespace facefit {

/// Looks for the same skin in both photos: small patches of the first, laid on the fitted head, are
/// looked for in the second. What the network says of turned faces is mostly what faces are like;
/// patches tell how far this one stands forward. Makes the view's pose better.
/// Returns places of the base head at rest and by how many millimetres each lies nearer to the
/// first photo's camera than the fit has it; empty if too few patches are found.
std::vector<fsm::WarpPoint> CompareDepth(const BaseHead& base, const Fit& fit,
                                         const fsm::Image& front, const fsm::Image& side,
                                         View& view);

}  // namespace facefit
