#include "face_fit/fit/side_view.h"

#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/profile_depth.h"
#include "face_fit/fit/side_pose.h"
#include "face_fit/fit/stereo_depth.h"

namespace facefit {

vm::Result<std::optional<SideView>> CorrectDepthBy(FaceNetworks& networks,
                                                   const fsm::Image& front_image,
                                                   const SidePhoto& side_photo, Fit& fit) {
  FigureCutout figure = CutOutFigure(side_photo.photo, SegmentPerson(networks, side_photo.photo));
  auto side_pose = FitSidePose(networks, fit.head, side_photo);
  if (side_pose) {
    FitByStereo corrected =
        CorrectDepthByStereo(front_image, side_photo.photo, *side_pose, std::move(fit));
    fit = std::move(corrected.fit);
    return SideView{&side_photo, corrected.side_pose, std::move(figure)};
  }
  // In full profile the network finds no face, or misplaces its points.
  if (auto corrected = CorrectDepthByProfile(figure.opacity, fit)) {
    fit = std::move(corrected->fit);
    return std::nullopt;
  }
  return std::unexpected(side_pose.error());
}

}  // namespace facefit
