#include "face_fit/side/use_side_photos.h"

#include <optional>
#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/side/profile_depth.h"
#include "face_fit/side/side_pose.h"
#include "face_fit/side/stereo.h"
#include "face_fit/side/stereo_depth.h"

namespace facefit {

SidePhotoFit UseSidePhotos(FaceNetworks& networks, const fsm::Image& front_photo,
                           std::span<const SidePhoto* const> side_photos, FaceFit fit) {
  SidePhotoFit result{std::move(fit), {}, {}};
  std::vector<const fsm::Image*> images;  // of the views
  for (const SidePhoto* side_photo : side_photos) {
    const auto pose = FitSidePose(networks, result.fit.head, *side_photo);
    if (pose) {
      auto [corrected, refined] =
          CorrectDepthByStereo(front_photo, side_photo->image, *pose, std::move(result.fit));
      result.fit = std::move(corrected);
      // Without the face: FindFigureOf trusts what a face from the front shows.
      result.views.push_back(
          {side_photo->face.value(), refined, FindFigure(networks, side_photo->image)});
      images.push_back(&side_photo->image);
      continue;
    }
    std::optional<FaceFit> corrected;
    if (pose.error().may_be_profile) {
      corrected =
          CorrectDepthByProfile(FindFigure(networks, side_photo->image).opacity, result.fit);
    }
    if (corrected) {
      result.fit = std::move(*corrected);
    } else {
      result.rejected.push_back({side_photo->path, pose.error().reason});
    }
  }
  // Later photos changed the depth that the poses of earlier ones were found on.
  for (std::size_t i = 0; i < images.size(); ++i) {
    CameraPose& pose = result.views[i].pose;
    const StereoMatcher matcher(result.fit.head, front_photo, *images[i]);
    pose = matcher.RefinePose(pose).value_or(pose);
  }
  return result;
}

}  // namespace facefit
