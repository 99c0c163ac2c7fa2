#pragma once

#include "fsm/image/image.h"
#include "hypermask/base/mask_layout.h"

namespace hypermask {

/// Draws the face for the projector: the part of its picture that lies in the mask's oval, where it
/// then falls on the mask; all else black, so that no light goes past it. Thread: one.
class FaceWarp {
 public:
  /// Part of the oval's radius over which the face fades out at its edge.
  static constexpr double kFade = 0.08;

  FaceWarp(MaskLayout layout, int width, int height);
  /// The face's picture from now on; its opacity is not used. REQUIRES: not empty.
  void SetFace(const fsm::Image& face);
  bool has_face() const { return !face_.rgba.empty(); }
  /// The projector's picture with the mask's plane (mm) where `map` has it; without a map, black.
  /// Valid until the next call.
  const fsm::Image& Draw(const PlaneMap* map);

  /// How the face's picture (pixels) lies on the mask's plane (mm).
  static PlaneMap PictureToMask(const MaskLayout& layout, int width, int height);

 private:
  const MaskLayout layout_;
  fsm::Image face_;          // faded to black outside of the oval
  std::vector<float> fade_;  // for each pixel of pictures of this size
  int fade_width_ = 0, fade_height_ = 0;
  fsm::Image drawn_;
};

}  // namespace hypermask
