#include "face_fit/fit/side_view.h"

#include <optional>
#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/profile_depth.h"
#include "face_fit/fit/side_pose.h"
#include "face_fit/fit/stereo.h"
#include "face_fit/fit/stereo_depth.h"

namespace facefit {

SidePhotoFit UseSidePhotos(FaceNetworks& networks, const fsm::Image& front_photo,
                           std::span<const SidePhoto* const> side_photos, FaceFit fit) {
  SidePhotoFit used{std::move(fit), {}, {}};
  for (const SidePhoto* side_photo : side_photos) {
    FigureCutout figure = FindFigure(networks, side_photo->image);
    const auto pose = FitSidePose(networks, used.fit.head, *side_photo);
    if (pose) {
      auto [corrected, refined] =
          CorrectDepthByStereo(front_photo, side_photo->image, *pose, std::move(used.fit));
      used.fit = std::move(corrected);
      used.views.push_back({side_photo, refined, std::move(figure)});
      continue;
    }
    // In full profile the network finds no face, or misplaces its points.
    std::optional<FaceFit> corrected;
    if (pose.error().code == vm::Errc::kUnavailable) {
      corrected = CorrectDepthByProfile(figure.opacity, used.fit);
    }
    if (corrected) {
      used.fit = std::move(*corrected);
    } else {
      used.rejected.push_back({side_photo->path, pose.error().text});
    }
  }
  // Later photos changed the depth that the poses of earlier ones were found on.
  for (auto& [side_photo, pose, figure] : used.views) {
    pose = RefineSidePose(used.fit.head, front_photo, side_photo->image, pose).value_or(pose);
  }
  return used;
}

}  // namespace facefit
