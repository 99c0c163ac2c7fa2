#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "face_fit/bake/texture_bake.h"
#include "face_fit/find/face/hand_points.h"
#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/fit/side_photo.h"

namespace facefit {

/// What is done on the way, told at the end of each step.
using StepDone = std::function<void(const char* step)>;

/// The face of that number, 1 = the largest. Error: kBadValue, there are fewer.
vm::Result<FoundFace> ChooseFace(std::span<const FoundFace> faces, int number);

/// Which face of a photo is meant. One that is known by its number is looked for in the photo and
/// in turned copies of it; one whose nose lies near a place (pixels) in the photo as it is; one of
/// which points are set by hand is not looked for.
struct FaceNumber {
  int number = 1;  ///< as of ChooseFace
};
struct FaceNear {
  glm::vec2 nose;
};
using FaceChoice = std::variant<FaceNumber, FaceNear, HandPoints>;

/// What of a photo is worked on: what a head made from the face shows, with all the photo's pixels
/// (CloseUpOf), or the whole as it is given.
enum class PhotoPart { kCloseUp, kWhole };

/// A photo from the front with what is seen in it before a head is fitted to points of its face.
struct FrontPhoto {
  fsm::Image photo;               ///< the part that is worked on, upright
  std::optional<FoundFace> face;  ///< in pixels of `photo`; nothing if none was found
  FigureCutout figure;
  Occlusion occlusion;  ///< of the face
  int faces = 0;        ///< how many were found
  int orientation = 1;  ///< EXIF's of the photo as it was given
  float scale = 1;      ///< pixels of `photo` by one of the photo as it was given
  /// Where the nose lies in the upright photo when that is at most kWorkingSize pixels to a side,
  /// and how large that is.
  glm::vec2 nose{0};
  glm::ivec2 whole_size{0};
};
/// Finds the face in a photo, takes the part of the photo to work on, cuts the figure out, and
/// looks for what is before the face. The face may be uncertain: who relies on it compares its
/// certainty with kCertainFace. Error: kBadValue, there are fewer faces than the number asked for,
/// but some; or as CheckWithin.
vm::Result<FrontPhoto> PrepareFront(
    FaceNetworks& networks, const ObservedHead& base, fsm::Image photo, const FaceChoice& choice,
    PhotoPart part, const StepDone& done = [](const char*) {});

/// Photos of the person from the side, and the networks they are looked at with.
struct SidePhotos {
  FaceNetworks& networks;
  std::vector<const SidePhoto*> photos;
};

/// A face that fsm can wear, and what is known of it.
struct MadeFace {
  Fit fit;
  TextureBake bake;
  std::string report;
  struct LeftOut {
    std::string path, why;
  };
  std::vector<LeftOut> left_out;  ///< photos from the side that did not help
};
/// Fits the base head, which outlives the result, to a face of a photo, corrects its depth by
/// photos from the side, and bakes them onto it. `face`: front.face, or what a user made of it.
/// `glasses`: whether the person wears them, else that is looked for. Errors:
/// of CheckSidePhotoCount and CheckFeaturesShown. Throws std::runtime_error if nothing can be drawn
/// with.
vm::Result<MadeFace> MakeFace(
    const ObservedHead& base, const FrontPhoto& front, const FoundFace& face,
    const std::optional<SidePhotos>& side_photos = {}, std::optional<bool> glasses = {},
    const StepDone& done = [](const char*) {});

}  // namespace facefit
