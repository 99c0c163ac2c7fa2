#include "face_fit/fit/side_view.h"

#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/profile_depth.h"
#include "face_fit/fit/side_pose.h"
#include "face_fit/fit/stereo.h"
#include "face_fit/fit/stereo_depth.h"

namespace facefit {

namespace {

/// Corrects the depth of the fit by a photo of a turned face, and keeps the photo for its colours.
void UseTurnedPhoto(FaceNetworks& networks, const fsm::Image& front_photo,
                    const SidePhoto& side_photo, const CameraPose& pose, SidePhotoFit& used) {
  auto [corrected, refined] =
      CorrectDepthByStereo(front_photo, side_photo.image, pose, std::move(used.fit));
  used.fit = std::move(corrected);
  // Without the face: FindFigureOf trusts what a face from the front shows.
  used.views.push_back({&side_photo, refined, FindFigure(networks, side_photo.image)});
}

/// Corrects the depth of the fit by the outline of a photo in full profile. Returns whether it
/// shows the profile.
bool UseProfilePhoto(FaceNetworks& networks, const SidePhoto& side_photo, SidePhotoFit& used) {
  auto corrected = CorrectDepthByProfile(FindFigure(networks, side_photo.image).opacity, used.fit);
  if (corrected) used.fit = std::move(*corrected);
  return corrected.has_value();
}

}  // namespace

SidePhotoFit UseSidePhotos(FaceNetworks& networks, const fsm::Image& front_photo,
                           std::span<const SidePhoto* const> side_photos, FaceFit fit) {
  SidePhotoFit used{std::move(fit), {}, {}};
  for (const SidePhoto* side_photo : side_photos) {
    const auto pose = FitSidePose(networks, used.fit.head, *side_photo);
    if (pose) {
      UseTurnedPhoto(networks, front_photo, *side_photo, *pose, used);
    } else if (!pose.error().may_be_profile || !UseProfilePhoto(networks, *side_photo, used)) {
      used.rejected.push_back({side_photo->path, pose.error().reason});
    }
  }
  // Later photos changed the depth that the poses of earlier ones were found on.
  for (auto& [side_photo, pose, figure] : used.views) {
    const StereoMatcher matcher(used.fit.head, front_photo, side_photo->image);
    pose = matcher.RefinePose(pose).value_or(pose);
  }
  return used;
}

}  // namespace facefit
