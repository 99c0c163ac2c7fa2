#pragma once

#include <string>

#include "face_fit/bake/texture_bake.h"
#include "face_fit/find/face_networks.h"

namespace facefit {

inline constexpr std::size_t kMostSideViews = 6;

/// A photo, set upright by what is seen in it. Errors: as ReadPhoto.
vm::Result<fsm::Image> ReadUpright(FaceNetworks& networks, const std::string& path);

/// Takes from a photo of the fitted person from the side what it tells of depth, and how it looks
/// there. Errors: as FitSideView; then the fit is as it was.
vm::Result<SideView> LookFromSide(FaceNetworks& networks, const BaseHead& base,
                                  const fsm::Image& front, const fsm::Image& side, Fit& fit);

}  // namespace facefit
