#include "face_fit/fit/extra_view.h"

#include "face_fit/find/face/upright.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/profile_depth.h"
#include "face_fit/picture/photo.h"

namespace facefit {

vm::Result<void> CheckExtras(const FaceNetworks* networks, const ExtraPhotos& extras) {
  if (extras.size() > kMostExtraPhotos) {
    return vm::Fail(vm::Errc::kLimit, "at most " + std::to_string(kMostExtraPhotos) +
                                          " photos from the side are used");
  }
  if (!extras.empty() && networks == nullptr) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "without the networks photos from the side cannot be used");
  }
  return {};
}

vm::Result<std::shared_ptr<const ExtraPhoto>> ReadExtraPhoto(FaceNetworks& networks,
                                                             const std::string& path) {
  auto photo = ReadPhoto(path);
  if (!photo) return std::unexpected(photo.error());
  UprightFaces found = FindUprightFaces(networks, *photo);
  return std::make_shared<const ExtraPhoto>(path, std::move(*photo), std::move(found.faces));
}

vm::Result<ExtraView> LookAtExtra(FaceNetworks& networks, const fsm::Image& front,
                                  const ExtraPhoto& extra, Fit& fit) {
  Cutout figure = CutOut(extra.photo, SegmentPerson(networks, extra.photo));
  if (auto view = FitExtraView(networks, fit.head, extra)) {
    RefineDepthByStereo(front, extra.photo, view->pose, fit);
    return ExtraView{*view, std::move(figure)};
  } else if (auto profile = RefineDepthByProfile(figure.opacity, fit)) {
    // In full profile the network finds no face, or places its points at will.
    return ExtraView{*profile, std::move(figure), true};
  } else {
    return std::unexpected(view.error());
  }
}

}  // namespace facefit
