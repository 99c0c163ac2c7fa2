#include "face_fit/dress/side_view.h"

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
  if (!view) return std::unexpected(view.error());
  Deepen(base, front, side, *view, fit);
  return SideView{std::move(*view), CutOut(side, FindFigure(networks, side))};
}

}  // namespace facefit
