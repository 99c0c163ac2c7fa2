#pragma once

#include <memory>
#include <string>
#include <vector>

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/extra_fit.h"

namespace facefit {

inline constexpr std::size_t kMostExtraPhotos = 6;
using ExtraPhotos = std::vector<std::shared_ptr<const ExtraPhoto>>;

/// Whether photos from the side can be used: there are at most kMostExtraPhotos, and, if there are
/// any, networks to look at them with. Errors: kLimit, kUnavailable.
vm::Result<void> CheckExtras(const FaceNetworks* networks, const ExtraPhotos& extras);

/// Reads a photo and sets it upright by what is seen in it. Errors: as ReadPhoto.
vm::Result<std::shared_ptr<const ExtraPhoto>> ReadExtraPhoto(FaceNetworks& networks,
                                                             const std::string& path);

/// A photo of the person from the side with what it tells of the head.
struct ExtraView {
  PoseFit fit;
  Cutout figure;
  /// A full profile: only its outline is used. Front and profile show too little of the same skin
  /// to bring both photos into one light.
  bool outline_only = false;
};
/// Takes from a photo of the fitted person from the side what it tells of depth, and how it looks
/// there. Errors: as FitExtraView; then the fit is as it was.
vm::Result<ExtraView> LookAtExtra(FaceNetworks& networks, const fsm::Image& front,
                                  const ExtraPhoto& extra, Fit& fit);

}  // namespace facefit
