#pragma once

#include "face_fit/fit/fit.h"

namespace facefit {

/// Corrects the depth of a fit's constraints until skin that two photos show lies at one place in
/// space, and refines the pose of the photo from the side. `pose`: that of `side` so far. Depth
/// stays as it is where too little skin is found in both.
CorrectedFit CorrectDepthByStereo(const Fit& fit, const fsm::Image& front, const fsm::Image& side,
                                  const PoseFit& pose);

}  // namespace facefit
