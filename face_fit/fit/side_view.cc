#include "face_fit/fit/side_view.h"

#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/profile_depth.h"
#include "face_fit/fit/side_pose.h"
#include "face_fit/fit/stereo_depth.h"

namespace facefit {

vm::Result<SideCorrection> CorrectDepthBy(FaceNetworks& networks, const fsm::Image& front,
                                          const SidePhoto& side, const Fit& fit) {
  FigureCutout figure = CutOutFigure(side.photo, SegmentPerson(networks, side.photo));
  const auto pose = FitSidePose(networks, fit.head, side);
  if (pose) {
    CorrectedFit corrected = CorrectDepthByStereo(fit, front, side.photo, *pose);
    return SideCorrection{std::move(corrected.fit), {corrected.side.pose, std::move(figure)}};
  }
  // In full profile the network finds no face, or places its points at will.
  if (auto corrected = CorrectDepthByProfile(fit, figure.opacity)) {
    return SideCorrection{std::move(corrected->fit),
                          {corrected->side.pose, std::move(figure), true}};
  }
  return std::unexpected(pose.error());
}

}  // namespace facefit
