#pragma once

#include <string>

#include "face_fit/find/figure/matte.h"
#include "face_fit/find/network/face_networks.h"
#include "face_fit/fit/fit.h"
#include "face_fit/fit/pose_fit.h"

namespace facefit {

/// A photo of the person from the side.
struct SideView {
  PoseFit fit;
  Cutout figure;
  /// A full profile: only its outline is used. Front and profile show too little of the same skin
  /// to bring both photos into one light.
  bool outline_only = false;
};

inline constexpr std::size_t kMostSideViews = 6;

/// A photo, set upright by what is seen in it. Errors: as ReadPhoto.
vm::Result<fsm::Image> ReadUpright(FaceNetworks& networks, const std::string& path);

/// Takes from a photo of the fitted person from the side what it tells of depth, and how it looks
/// there. Errors: as FitSideView (side_fit.h); then the fit is as it was.
vm::Result<SideView> LookFromSide(FaceNetworks& networks, const BaseHead& base,
                                  const fsm::Image& front, const fsm::Image& side, Fit& fit);

}  // namespace facefit
