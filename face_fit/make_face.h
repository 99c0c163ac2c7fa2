#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "face_fit/bake/texture_bake.h"
#include "face_fit/find/face/occlusion_detector.h"
#include "face_fit/fit/extra_view.h"

namespace facefit {

/// The face of that number, 1 = the largest. Error: kBadValue, there are fewer.
vm::Result<FoundFace> ChooseFace(std::span<const FoundFace> faces, int number);

/// A photo from the front with what is seen in it before a head is fitted to points of its face.
struct FrontPhoto {
  fsm::Image photo;
  Cutout figure;
  Occlusion occlusion;  ///< of the face that was found
  int faces = 0;        ///< how many were found
};
/// `face`: in pixels of `photo`; nullptr if none was found.
FrontPhoto LookAtFront(FaceNetworks& networks, const BaseHead& base, fsm::Image photo,
                       const FoundFace* face, int faces);

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
/// What is done on the way, told at the end of each step.
using StepDone = std::function<void(const char* step)>;
/// Fits the base head, which outlives the result, to a face of a photo, corrects its depth by
/// photos from the side, and bakes them onto it. `networks` look at `extras`; nullptr will do where
/// there are none. `glasses`: whether the person wears them, else that is looked for. Throws
/// std::runtime_error with the error of CheckExtras, or if nothing can be drawn with.
MadeFace MakeFace(const BaseHead& base, const FrontPhoto& front, const FoundFace& face,
                  FaceNetworks* networks, const ExtraPhotos& extras,
                  std::optional<bool> glasses = std::nullopt, const StepDone& done = {});

}  // namespace facefit
