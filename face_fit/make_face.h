#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "face_fit/bake/bake_head.h"
#include "face_fit/find/face/hand_points.h"
#include "face_fit/front_photo.h"

namespace facefit {

class FaceNetworks;

/// Is called with the name of each step when it is done.
using StepDone = std::function<void(const char* step)>;

/// How a face of a photo is chosen: FaceNumber, by its size, searched in the photo and in turned
/// copies of it; FaceNear, as the face whose nose lies nearest to a pixel of the photo as it is, at
/// any distance; HandPoints, from points set by hand, without a search.
struct FaceNumber {
  int number = 1;  ///< 1 = the largest
};
struct FaceNear {
  glm::vec2 nose;
};
using FaceChoice = std::variant<FaceNumber, FaceNear, HandPoints>;

/// How much of a photo is worked on: the surroundings of the face with all the photo's pixels
/// (CloseUpOf), or all of it as given.
enum class PhotoExtent { kCloseUp, kWhole };

/// Finds the face in a photo, selects what to work on, cuts the figure out, and checks whether
/// something hides the face. The face may be uncertain: compare its certainty with kCertainFace.
/// Errors: kBadValue, there are faces but fewer than the number asked for; as CheckWithin.
vm::Result<PreparedFront> PrepareFront(
    FaceNetworks& networks, const ObservedHead& base, fsm::Image photo, const FaceChoice& choice,
    PhotoExtent extent, const StepDone& done = [](const char*) {});

/// A face that fsm can wear, and what is known of it.
struct MadeFace {
  FaceFit fit;
  BakedHead baked;
  std::string report;
  std::vector<RejectedPhoto> rejected;
};
/// Photos of the person from the side, and the networks that look at them.
struct SidePhotoSet {
  FaceNetworks& networks;
  std::span<const SidePhoto* const> photos;
};
/// Fits the base head, which outlives the result, to a face in a photo, corrects its depth by
/// photos from the side, and bakes all photos onto it. `glasses`: whether the person wears glasses;
/// if empty, that is detected. Errors: as CheckFeaturesShown. Throws std::runtime_error if
/// rendering is impossible. REQUIRES: as CheckSidePhotoCount.
vm::Result<MadeFace> MakeFace(
    const ObservedHead& base, const FrontPhoto& front, const FrontFace& face,
    std::optional<SidePhotoSet> from_side = {}, std::optional<bool> glasses = {},
    const StepDone& done = [](const char*) {});

}  // namespace facefit
