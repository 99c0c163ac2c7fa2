#pragma once

#include <string>
#include <vector>

#include "face_fit/fit/fit.h"
#include "face_fit/fit/pose_fit.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Another photo of the person, upright, and the faces found in it.
struct ExtraPhoto {
  std::string path;
  fsm::Image photo;
  std::vector<FoundFace> faces;
};

/// Finds the pose of the fitted head in another photo of the person, from the side. The head is
/// drawn in that pose and shown to the same network: what the network gets wrong of the drawn head
/// is subtracted from what it says of the photo. Errors (kBadValue, in words): no face; from the
/// front again; turned too far; not this face.
vm::Result<PoseFit> FitExtraView(FaceNetworks& networks, const FittedHead& fitted,
                                 const ExtraPhoto& extra);

/// Corrects the depth of the fit's constraints until skin seen in both photos lies at one place in
/// space, warps the head again, and refines `pose`, that of the photo from the side. Leaves both as
/// they are if too little skin is found in both.
void RefineDepthByStereo(const fsm::Image& front, const fsm::Image& extra, CameraPose& pose,
                         Fit& fit);

}  // namespace facefit
