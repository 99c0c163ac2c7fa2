#pragma once

#include "face_fit/complete/complete_figure.h"
#include "face_fit/fit/extra_view.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// A head made from a photo. Left half of its `photo`: the skin, laid out by the head's texture
/// coordinates, alpha = how much is skin. Right half: the figure with hair, neck and clothes, and
/// its opacity.
struct TextureBake {
  fsm::PhotoHead head;
  float coverage = 0;   ///< part of the face's map that the photo shows
  Completed completed;  ///< what of the figure it does not
};

/// `figure`: of `photo`; `extras`: photos of the same person from the side, may be empty. Pure;
/// thread: any.
TextureBake BakeTexture(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                        const Cutout& figure, std::span<const ExtraView> extras);

}  // namespace facefit
