#include "face_fit/fit/side_view.h"

#include "face_fit/find/face/upright.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/profile_fit.h"
#include "face_fit/picture/photo.h"

namespace facefit {

vm::Result<std::shared_ptr<const SidePhoto>> ReadSidePhoto(FaceNetworks& networks,
                                                           const std::string& path) {
  auto photo = ReadPhoto(path);
  if (!photo) return std::unexpected(photo.error());
  UprightFaces found = FindUprightFaces(networks, *photo);
  return std::make_shared<const SidePhoto>(path, std::move(*photo), std::move(found.faces));
}

vm::Result<SideView> LookFromSide(FaceNetworks& networks, const fsm::Image& front,
                                  const SidePhoto& side, Fit& fit) {
  Cutout figure = CutOut(side.photo, SegmentPerson(networks, side.photo));
  if (auto view = FitSideView(networks, fit.head, side)) {
    RefineDepthBySide(front, side.photo, view->pose, fit);
    return SideView{*view, std::move(figure)};
  } else if (auto profile = RefineDepthByProfile(figure.opacity, fit)) {
    // In full profile the network finds no face, or places its points at will.
    return SideView{*profile, std::move(figure), true};
  } else {
    return std::unexpected(view.error());
  }
}

}  // namespace facefit
