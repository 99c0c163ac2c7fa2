#include "face_fit/side/side_view.h"

#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/side/profile_depth.h"
#include "face_fit/side/side_pose.h"
#include "face_fit/side/stereo.h"
#include "face_fit/side/stereo_depth.h"

namespace facefit {

namespace {

/// Corrects the depth of the fit by a photo of a turned face. Returns what the map takes of it.
SideView UseTurnedPhoto(FaceNetworks& networks, const fsm::Image& front_photo,
                        const SidePhoto& side_photo, const CameraPose& pose, FaceFit& fit) {
  auto [corrected, refined] =
      CorrectDepthByStereo(front_photo, side_photo.image, pose, std::move(fit));
  fit = std::move(corrected);
  // Without the face: FindFigureOf trusts what a face from the front shows.
  return {side_photo.face.value(), refined, FindFigure(networks, side_photo.image)};
}

/// Corrects the depth of the fit by the outline of a photo in full profile. Returns whether it
/// shows the profile.
bool UseProfilePhoto(FaceNetworks& networks, const SidePhoto& side_photo, FaceFit& fit) {
  auto corrected = CorrectDepthByProfile(FindFigure(networks, side_photo.image).opacity, fit);
  if (corrected) fit = std::move(*corrected);
  return corrected.has_value();
}

}  // namespace

SidePhotoFit UseSidePhotos(FaceNetworks& networks, const fsm::Image& front_photo,
                           std::span<const SidePhoto* const> side_photos, FaceFit fit) {
  SidePhotoFit result{std::move(fit), {}, {}};
  std::vector<const fsm::Image*> images;  // of the views
  for (const SidePhoto* side_photo : side_photos) {
    const auto pose = FitSidePose(networks, result.fit.head, *side_photo);
    if (pose) {
      result.views.push_back(UseTurnedPhoto(networks, front_photo, *side_photo, *pose, result.fit));
      images.push_back(&side_photo->image);
    } else if (!pose.error().may_be_profile ||
               !UseProfilePhoto(networks, *side_photo, result.fit)) {
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
