#include "face_fit/fit/side_view.h"

#include "face_fit/find/face/upright.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/profile_fit.h"
#include "face_fit/fit/side_fit.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/photo.h"

namespace facefit {

vm::Result<fsm::Image> ReadUpright(FaceNetworks& networks, const std::string& path) {
  auto photo = ReadPhoto(path);
  if (!photo) return photo;
  if (const int orientation = UprightOrientation(networks, *photo); orientation != 1)
    *photo = Turned(*photo, orientation);
  return photo;
}

vm::Result<SideView> LookFromSide(FaceNetworks& networks, const BaseHead& base,
                                  const fsm::Image& front, const fsm::Image& side, Fit& fit) {
  auto view = FitSideView(networks, base, fit.head, side);
  if (!view) {
    // In full profile the network finds no face, or places its points at will.
    Cutout figure = CutOut(side, FindPerson(networks, side));
    auto profile = RefineDepthByProfile(base, figure.opacity, fit);
    if (!profile) return std::unexpected(view.error());
    return SideView{*profile, std::move(figure), true};
  }
  RefineDepthBySide(base, front, side, view->pose, fit);
  return SideView{*view, CutOut(side, FindPerson(networks, side))};
}

}  // namespace facefit
