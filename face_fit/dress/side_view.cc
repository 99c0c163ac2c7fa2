#include "face_fit/dress/side_view.h"

#include "face_fit/dress/profile.h"
#include "face_fit/find/figure_finder.h"
#include "face_fit/find/upright.h"

namespace facefit {

vm::Result<fsm::Image> ReadUpright(FaceNetworks& networks, const std::string& path) {
  auto photo = ReadPhoto(path);
  if (!photo) return photo;
  if (const int way = UprightWay(networks, *photo); way != 1) *photo = Turned(*photo, way);
  return photo;
}

vm::Result<SideView> LookFromSide(FaceNetworks& networks, const BaseHead& base,
                                  const fsm::Image& front, const fsm::Image& side, Fit& fit) {
  auto view = PlaceView(networks, base, fit, side);
  if (!view) {
    // In full profile the network finds no face, or places its points at will.
    Figure figure = CutOut(side, FindFigure(networks, side));
    auto profile = DeepenByProfile(base, figure.opacity, fit);
    if (!profile) return std::unexpected(view.error());
    return SideView{{{}, profile->pose, profile->residual_mm}, std::move(figure), true};
  }
  Deepen(base, front, side, *view, fit);
  return SideView{std::move(*view), CutOut(side, FindFigure(networks, side))};
}

}  // namespace facefit
